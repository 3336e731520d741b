/* status.h: passing a failure on. A function that has nothing to free returns at once, by AG_TRY; one that has goes on
 * with "if (status == AG_OK) status = ..." to the end, where all is freed. A status is compared with AG_OK, not taken
 * for a boolean. Threads: any. */
#ifndef AFTERGLOW_STATUS_H
#define AFTERGLOW_STATUS_H

#include "afterglow/base.h"

/* Returns the status of a call that has failed; else goes on. */
#define AG_TRY(call)                                                                                                   \
    do {                                                                                                               \
        const ag_status try_status = (call);                                                                           \
        if (try_status != AG_OK)                                                                                       \
            return try_status;                                                                                         \
    } while (0)

#endif
