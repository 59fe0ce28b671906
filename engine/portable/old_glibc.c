/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Lets the library load on systems whose C library is older than the one that it was linked with. Only a few of the
 * functions that it uses are of a recent version there. References to them are turned by the linker (--wrap, see
 * CMakeLists.txt) into calls of what stands here, and that calls the version that every glibc has. In today's glibc the
 * two differ in how errors are told through errno, which the engine does not read, not in what they compute.
 */
#define _GNU_SOURCE
#include <pthread.h>
#include <sched.h>
#include <sys/stat.h>
#include <time.h>

#define OLD(result, name, version, parameters, arguments)                                                              \
    extern result old_##name parameters;                                                                               \
    __asm__(".symver old_" #name "," #name "@" version);                                                               \
    result __wrap_##name parameters;                                                                                   \
    result __wrap_##name parameters {                                                                                  \
        return old_##name arguments;                                                                                   \
    }

OLD(double, exp, "GLIBC_2.2.5", (double x), (x))
OLD(double, exp2, "GLIBC_2.2.5", (double x), (x))
OLD(double, log, "GLIBC_2.2.5", (double x), (x))
OLD(double, log2, "GLIBC_2.2.5", (double x), (x))
OLD(double, pow, "GLIBC_2.2.5", (double x, double y), (x, y))
OLD(double, hypot, "GLIBC_2.2.5", (double x, double y), (x, y))
OLD(float, hypotf, "GLIBC_2.2.5", (float x, float y), (x, y))
OLD(int, pthread_create, "GLIBC_2.2.5",
    (pthread_t * thread, const pthread_attr_t *attributes, void *(*start)(void *), void *argument),
    (thread, attributes, start, argument))
OLD(int, pthread_join, "GLIBC_2.2.5", (pthread_t thread, void **result), (thread, result))
OLD(int, pthread_once, "GLIBC_2.2.5", (pthread_once_t * once, void (*function)(void)), (once, function))
OLD(int, pthread_key_create, "GLIBC_2.2.5", (pthread_key_t * key, void (*destroy)(void *)), (key, destroy))
OLD(int, pthread_key_delete, "GLIBC_2.2.5", (pthread_key_t key), (key))
OLD(void *, pthread_getspecific, "GLIBC_2.2.5", (pthread_key_t key), (key))
OLD(int, pthread_setspecific, "GLIBC_2.2.5", (pthread_key_t key, const void *value), (key, value))
OLD(int, pthread_attr_setstacksize, "GLIBC_2.2.5", (pthread_attr_t * attributes, size_t size), (attributes, size))
OLD(int, pthread_getaffinity_np, "GLIBC_2.3.4", (pthread_t thread, size_t size, cpu_set_t *set), (thread, size, set))
OLD(int, pthread_setaffinity_np, "GLIBC_2.3.4", (pthread_t thread, size_t size, const cpu_set_t *set),
    (thread, size, set))
OLD(int, __fxstat64, "GLIBC_2.2.5", (int version, int file, struct stat64 *status), (version, file, status))

int __wrap_fstat64(int file, struct stat64 *status);
int __wrap_fstat64(int file, struct stat64 *status) {
    return old___fxstat64(1, file, status); /* 1: the struct's only version on x86-64 */
}

/* libstdc++ asks whether there is one thread only, to save atomics: there is not. */
char __libc_single_threaded = 0;

/* Waits until a time of any clock. Old glibcs know times of the wall clock alone, so the time that is left is
 * converted; where somebody sets the clock meanwhile, the wait is longer or shorter by as much. */
int __wrap_pthread_cond_clockwait(pthread_cond_t *condition, pthread_mutex_t *mutex, clockid_t clock,
                                  const struct timespec *until);
int __wrap_pthread_cond_clockwait(pthread_cond_t *condition, pthread_mutex_t *mutex, clockid_t clock,
                                  const struct timespec *until) {
    struct timespec now, wall;
    clock_gettime(clock, &now);
    clock_gettime(CLOCK_REALTIME, &wall);
    wall.tv_sec += until->tv_sec - now.tv_sec;
    wall.tv_nsec += until->tv_nsec - now.tv_nsec;
    while (wall.tv_nsec < 0) {
        wall.tv_nsec += 1000000000;
        --wall.tv_sec;
    }
    while (wall.tv_nsec >= 1000000000) {
        wall.tv_nsec -= 1000000000;
        ++wall.tv_sec;
    }
    return pthread_cond_timedwait(condition, mutex, &wall);
}
