// SPDX-License-Identifier: BSD-3-Clause
// A library to be preloaded: folders whose path ends in $CARROM_FAIL_LISTING can be opened, but to
// read their entries fails with EIO, as on a failing disk.
#define _GNU_SOURCE
#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static int must_fail(DIR* folder) {
    const char* const end = getenv("CARROM_FAIL_LISTING");
    char link[64], path[4096];
    snprintf(link, sizeof link, "/proc/self/fd/%d", dirfd(folder));
    const ssize_t n = readlink(link, path, sizeof path - 1);
    if (end == NULL || n < (ssize_t)strlen(end)) return 0;
    path[n] = 0;
    return strcmp(path + n - strlen(end), end) == 0;
}

struct dirent* readdir(DIR* folder) {
    if (must_fail(folder)) {
        errno = EIO;
        return NULL;
    }
    struct dirent* (*whole)(DIR*) = (struct dirent * (*)(DIR*)) dlsym(RTLD_NEXT, "readdir");
    return whole(folder);
}

struct dirent64* readdir64(DIR* folder) {
    if (must_fail(folder)) {
        errno = EIO;
        return NULL;
    }
    struct dirent64* (*whole)(DIR*) = (struct dirent64 * (*)(DIR*)) dlsym(RTLD_NEXT, "readdir64");
    return whole(folder);
}
