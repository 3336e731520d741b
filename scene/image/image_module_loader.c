/* image_module_loader.c: dlopen of the image module.
 * Flow: image_reader.c, image_file.c (renderer) -> [here] -> image_oiio.cpp.
 * Threads: any; one mutex, held while the module is being opened. */
#define _POSIX_C_SOURCE 200809L
#include "image/image_module_loader.h"

#include "image/module_folders.h"

#include <dlfcn.h>
#include <fenv.h>
#include <limits.h>
#include <pthread.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MESSAGE_SIZE = 2048 };

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static const image_module *module;

/* Appends a text; what does not fit is cut. */
static void append(char *text, size_t size, const char *addition)
{
    size_t length = strlen(text);
    while (*addition != '\0' && length + 1 < size)
        text[length++] = *addition++;
    text[length] = '\0';
}

/* Adds "'path' (reason)" to the list in tried. */
static void add_attempt(char *tried, size_t tried_size, const char *path, const char *reason)
{
    append(tried, tried_size, tried[0] != '\0' ? ", '" : "'");
    append(tried, tried_size, path);
    append(tried, tried_size, "' (");
    append(tried, tried_size, reason);
    append(tried, tried_size, ")");
}

static const image_module *open_file(const char *path, char *tried, size_t tried_size)
{
    if (access(path, F_OK) != 0) {
        add_attempt(tried, tried_size, path, "not there");
        return NULL;
    }

    /* The 261 libraries behind it start threads, which inherit our signal mask: none of them shall take our signals.
     * And some libraries' start-up code changes the floating-point mode, on which the picture's bits depend. */
    sigset_t all_signals, saved_signals;
    fenv_t saved_mode;
    sigfillset(&all_signals);
    pthread_sigmask(SIG_SETMASK, &all_signals, &saved_signals);
    fegetenv(&saved_mode);
    void *handle = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    const char *error = handle ? NULL : dlerror();
    const image_module *opened = NULL;
    if (handle) {
        image_module_entry *entry;
        *(void **)&entry = dlsym(handle, IMAGE_MODULE_ENTRY_NAME); /* POSIX's way from object to function pointer */
        opened = entry ? entry() : NULL;
    }
    fesetenv(&saved_mode);
    pthread_sigmask(SIG_SETMASK, &saved_signals, NULL);

    if (opened && opened->interface_number == IMAGE_MODULE_INTERFACE)
        return opened; /* stays open for good: OpenImageIO's libraries do not survive being closed */
    if (!error)
        error = opened ? "is of another release" : "is no image module of ours, or OpenImageIO failed to start";
    add_attempt(tried, tried_size, path, error);
    return NULL;
}

const image_module *image_module_open_from(const char *const *folders, int folder_count, char *message,
                                           size_t message_size)
{
    char tried[MESSAGE_SIZE] = "";
    snprintf(message, message_size, "%s", "");
    for (int i = 0; i < folder_count; i++) {
        char path[PATH_MAX];
        if (snprintf(path, sizeof path, "%s/%s", folders[i], IMAGE_MODULE_FILE_NAME) >= (int)sizeof path)
            continue;
        const image_module *opened = open_file(path, tried, sizeof tried);
        if (opened)
            return opened;
    }
    snprintf(message, message_size, "the image module cannot be opened; tried: %s",
             tried[0] != '\0' ? tried : "nothing");
    return NULL;
}

static const image_module *open_anywhere(char *message, size_t message_size)
{
    module_folders found;
    const char *folders[MODULE_FOLDERS_MAX];
    module_folders_find(&found);
    for (int i = 0; i < found.count; i++)
        folders[i] = found.paths[i];
    return image_module_open_from(folders, found.count, message, message_size);
}

const image_module *image_module_get(char *message, size_t message_size)
{
    snprintf(message, message_size, "%s", "");
    pthread_mutex_lock(&lock);
    if (!module)
        module = open_anywhere(message, message_size);
    const image_module *result = module;
    pthread_mutex_unlock(&lock);
    return result;
}
