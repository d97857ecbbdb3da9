/* An importer whose callbacks do not come back: they jump if this is compiled as C, and throw if as C++. */
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <string.h>

#ifdef __cplusplus
#include <stdexcept>
#include <string>
#define LEAVE(name) throw std::runtime_error(name)
#define LOCAL thread_local
extern "C" {
#else
#include <setjmp.h>
#define LEAVE(name) ((void)(name), longjmp(outside, 1))
#define LOCAL _Thread_local
static LOCAL jmp_buf outside;
#endif

/* Calls that callbacks still return from; negative if they always do. */
static LOCAL int left = -1;
/* Messages, all of them one after the other, each ended by a line break. */
static LOCAL char messages[65536];

void importer_leave_after(int calls) { left = calls; }

void importer_take_messages(char *target, size_t size) {
    strncpy(target, messages, size - 1);
    target[size - 1] = 0;
    messages[0] = 0;
}

static void called(const char *name) {
    if (left == 0) {
        left = -1;
        LEAVE(name);
    }
    if (left > 0) left--;
}

static void keep(const char *message) {
    strncat(messages, message, sizeof messages - strlen(messages) - 2);
    strcat(messages, "\n");
}

void importer_log2(void *environment, const char *name, int status, const char *category, const char *message, ...) {
    (void)environment, (void)name, (void)status, (void)category;
    keep(message);
    called("log2");
}

void importer_log3(void *environment, int status, const char *category, const char *message) {
    (void)environment, (void)status, (void)category;
    keep(message);
    called("log3");
}

void importer_update(void *environment, double time, bool set, bool get, bool finished, bool early, bool *requested,
                     double *return_time) {
    (void)environment, (void)time, (void)set, (void)get, (void)finished, (void)early;
    *requested = false;
    *return_time = time;
    called("update");
}

void importer_clock_update(void *environment) {
    (void)environment;
    called("clock_update");
}

/* Whether `call` was left by a callback; its result if it was not. */
int importer_protect(int (*call)(void *), void *argument, int *result) {
#ifdef __cplusplus
    try {
        *result = call(argument);
        return 0;
    } catch (const std::runtime_error &error) {
        return std::string(error.what()).empty() ? 0 : 1;
    }
#else
    if (setjmp(outside)) return 1;
    *result = call(argument);
    return 0;
#endif
}

#ifdef __cplusplus
}
#endif
