/* A library for LD_PRELOAD that makes calls of the operating system fail. faults.py builds and uses it.
 *
 * FAULT_FOLDER  only files below this folder are concerned
 * FAULT_CALL    the call that fails: write, sync, rename, open, or short (a write stores only a part of its bytes)
 * FAULT_AT      number of the first such call that fails, from 1; later calls fail too, as on a full disk
 * FAULT_ERROR   number of the error, see errno(3)
 * FAULT_ONCE    set: only one call fails
 * FAULT_CLOCK   set: the time of day jumps by up to this many seconds, forwards and backwards
 *
 * When a call has failed, the library creates the file FAULT_MARK, so that the caller knows it. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/types.h>
#include <time.h>
#include <unistd.h>

static atomic_long calls;

#define REAL(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

static int chosen(const char* call) {
    const char* wanted = getenv("FAULT_CALL");
    return wanted != NULL && strcmp(wanted, call) == 0;
}

static int below_folder(const char* path) {
    const char* folder = getenv("FAULT_FOLDER");
    if (folder == NULL || path == NULL || strncmp(path, folder, strlen(folder)) != 0) return 0;
    char next = path[strlen(folder)];
    return next == '/' || next == '\0';
}

static int path_concerned(const char* path) {
    char absolute[PATH_MAX];
    if (path == NULL) return 0;
    if (path[0] == '/') return below_folder(path);
    if (getcwd(absolute, sizeof absolute - 2) == NULL) return 0;
    strcat(absolute, "/");
    strncat(absolute, path, sizeof absolute - strlen(absolute) - 1);
    return below_folder(absolute);
}

static int descriptor_concerned(int descriptor) {
    char link[64];
    char path[PATH_MAX];
    snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
    const ssize_t length = readlink(link, path, sizeof path - 1);
    if (length < 0) return 0;
    path[length] = '\0';
    return below_folder(path);
}

/* Counts the call. Returns 1 if it must fail. */
static int due(void) {
    const char* at = getenv("FAULT_AT");
    const long first = at == NULL ? 1 : atol(at);
    const long now = atomic_fetch_add(&calls, 1) + 1;
    if (now < first || (getenv("FAULT_ONCE") != NULL && now != first)) return 0;
    const char* mark = getenv("FAULT_MARK");
    if (mark != NULL) {
        const int file = REAL(open)(mark, O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
        if (file >= 0) close(file);
    }
    const char* error = getenv("FAULT_ERROR");
    errno = error == NULL ? ENOSPC : atoi(error);
    return 1;
}

/* Returns the number of bytes to write instead of `count`. */
static size_t shortened(int descriptor, size_t count) {
    if (!chosen("short") || count < 2 || !descriptor_concerned(descriptor)) return count;
    const int error = errno;
    const size_t part = due() ? 1 + count / 3 : count;
    errno = error;
    return part;
}

ssize_t write(int descriptor, const void* bytes, size_t count) {
    if (chosen("write") && descriptor_concerned(descriptor) && due()) return -1;
    return REAL(write)(descriptor, bytes, shortened(descriptor, count));
}

ssize_t pwrite(int descriptor, const void* bytes, size_t count, off_t offset) {
    if (chosen("write") && descriptor_concerned(descriptor) && due()) return -1;
    return REAL(pwrite)(descriptor, bytes, shortened(descriptor, count), offset);
}

ssize_t pwrite64(int descriptor, const void* bytes, size_t count, off64_t offset) {
    if (chosen("write") && descriptor_concerned(descriptor) && due()) return -1;
    return REAL(pwrite64)(descriptor, bytes, shortened(descriptor, count), offset);
}

int fsync(int descriptor) {
    if (chosen("sync") && descriptor_concerned(descriptor) && due()) return -1;
    return REAL(fsync)(descriptor);
}

int fdatasync(int descriptor) {
    if (chosen("sync") && descriptor_concerned(descriptor) && due()) return -1;
    return REAL(fdatasync)(descriptor);
}

int rename(const char* from, const char* to) {
    if (chosen("rename") && path_concerned(to) && due()) return -1;
    return REAL(rename)(from, to);
}

static int refuses_open(const char* path, int flags) {
    const int writes = (flags & O_ACCMODE) != O_RDONLY || (flags & O_CREAT) != 0;
    return chosen("open") && writes && path_concerned(path) && due();
}

#define MODE_OF(flags, mode)                        \
    mode_t mode = 0;                                \
    if (((flags) & (O_CREAT | O_TMPFILE)) != 0) {   \
        va_list arguments;                          \
        va_start(arguments, flags);                 \
        mode = (mode_t)va_arg(arguments, int);      \
        va_end(arguments);                          \
    }

int open(const char* path, int flags, ...) {
    MODE_OF(flags, mode)
    if (refuses_open(path, flags)) return -1;
    return REAL(open)(path, flags, mode);
}

int open64(const char* path, int flags, ...) {
    MODE_OF(flags, mode)
    if (refuses_open(path, flags)) return -1;
    return REAL(open64)(path, flags, mode);
}

static void jump(time_t* seconds) {
    const char* most = getenv("FAULT_CLOCK");
    if (most == NULL) return;
    const long range = atol(most);
    *seconds += random() % (2 * range + 1) - range;
}

int clock_gettime(clockid_t clock, struct timespec* now) {
    const int result = REAL(clock_gettime)(clock, now);
    if (clock == CLOCK_REALTIME) jump(&now->tv_sec);
    return result;
}

int gettimeofday(struct timeval* now, void* zone) {
    const int result = REAL(gettimeofday)(now, zone);
    jump(&now->tv_sec);
    return result;
}

time_t time(time_t* now) {
    struct timespec exact;
    clock_gettime(CLOCK_REALTIME, &exact);
    if (now != NULL) *now = exact.tv_sec;
    return exact.tv_sec;
}
