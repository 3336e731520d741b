/* image_module_loader.c: dlopen of the image module.
 * Flow: image_reader.c, image_file.c (renderer) -> [here] -> image_oiio.cpp.
 * Threads: any; one mutex, held while the module is being opened. */
#define _GNU_SOURCE /* dladdr1, secure_getenv */
#include "image/image_module_loader.h"

#include <dlfcn.h>
#include <fenv.h>
#include <limits.h>
#include <link.h>
#include <pthread.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { FOLDER_LIMIT = 4, MESSAGE_SIZE = 2048 };

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static const image_module *module;

/* Cuts what does not fit. */
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

/* The folder of the shared object, or of the program, that this code is part of. */
static bool own_folder(char out_folder[PATH_MAX])
{
    Dl_info info;
    struct link_map *map = NULL;
    void *address;
    const image_module *(*function)(char *, size_t) = image_module_get;
    memcpy(&address, &function, sizeof address);
    if (dladdr1(address, &info, (void **)&map, RTLD_DL_LINKMAP) == 0 || !map)
        return false;
    /* The program itself has an empty name there, and argv[0] would not do: it need not hold a path. */
    if (!realpath(map->l_name[0] != '\0' ? map->l_name : "/proc/self/exe", out_folder))
        return false;
    char *slash = strrchr(out_folder, '/');
    if (!slash)
        return false;
    *slash = '\0';
    return true;
}

static const image_module *open_anywhere(char *message, size_t message_size)
{
    char own[PATH_MAX], beside[PATH_MAX + 32], in_lib[PATH_MAX + 32];
    const char *folders[FOLDER_LIMIT];
    int count = 0;
    const char *environment = secure_getenv("AFTERGLOW_MODULE_DIR");
    if (environment && environment[0] != '\0')
        folders[count++] = environment;
    if (own_folder(own)) {
        snprintf(beside, sizeof beside, "%s/afterglow", own);
        snprintf(in_lib, sizeof in_lib, "%s/../lib/afterglow", own);
        folders[count++] = beside;
        folders[count++] = in_lib;
    }
    folders[count++] = AG_MODULE_INSTALL_DIR;
    return image_module_open_from(folders, count, message, message_size);
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
