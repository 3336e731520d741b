/* module_folders.c: see module_folders.h. */
#define _GNU_SOURCE /* dladdr1, secure_getenv */
#include "image/module_folders.h"

#include <dlfcn.h>
#include <link.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Finds the folder of the shared object, or of the program, that this code is part of. */
static bool own_folder(char out_folder[PATH_MAX])
{
    Dl_info info;
    struct link_map *map = NULL;
    void *address;
    void (*function)(module_folders *) = module_folders_find;
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

static char *next_path(module_folders *folders) { return folders->paths[folders->count++]; }

void module_folders_find(module_folders *out_folders)
{
    enum { SIZE = sizeof out_folders->paths[0] };
    char own[PATH_MAX];
    out_folders->count = 0;
    const char *environment = secure_getenv("AFTERGLOW_MODULE_DIR");
    if (environment && environment[0] != '\0' && strlen(environment) < SIZE)
        snprintf(next_path(out_folders), SIZE, "%s", environment);
    if (own_folder(own)) {
        snprintf(next_path(out_folders), SIZE, "%s/afterglow", own);
        snprintf(next_path(out_folders), SIZE, "%s/../lib/afterglow", own);
    }
    snprintf(next_path(out_folders), SIZE, "%s", AG_MODULE_INSTALL_DIR);
}
