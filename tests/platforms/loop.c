/* Runs a plant and a controller of one shared library through FMI 2.0 and prints what `maglev-fmu trace` prints of the
 * same loop: per step all outputs of the plant before the step, then all outputs of the controller after its tick, each
 * as the 16 hexadecimal digits of its bits. For platforms that no test can run on otherwise.
 *
 *     loop LIBRARY < script
 *
 * Lines of the script; `p` is the plant, `c` the controller, and reals are bits, too:
 *     make p NAME TOKEN        real p REFERENCE BITS     item p REFERENCE NUMBER    flag p REFERENCE 0|1
 *     wire p FROM TO           (the other model takes what this one gives)          out p REFERENCE
 *     run STEPS STEP_SIZE
 */
#include <inttypes.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#ifdef _WIN32
#include <windows.h>
#else
#include <dlfcn.h>
#endif

enum { OK = 0, CO_SIMULATION = 1, MOST = 32 };

typedef void Logger(void *, const char *, int, const char *, const char *, ...);

typedef struct {
    Logger *log;
    void *(*allocate)(size_t, size_t);
    void (*release)(void *);
    void *step_finished, *environment;
} Callbacks;

typedef struct {
    void *instance;
    size_t wire_count, output_count;
    unsigned from[MOST], to[MOST], outputs[MOST];
} Model;

static void *library;

static void fail(const char *what, const char *which) {
    fprintf(stderr, "%s: %s\n", what, which);
    exit(1);
}

static void say(void *environment, const char *name, int status, const char *category, const char *message, ...) {
    va_list values;
    (void)environment, (void)status;
    va_start(values, message);
    fprintf(stderr, "%s [%s]: ", name, category);
    vfprintf(stderr, message, values);
    fputc('\n', stderr);
    va_end(values);
}

/* Copies the address of a function to where a pointer to one is: a cast would be none of C. */
static void find(const char *name, void *function, size_t size) {
#ifdef _WIN32
    FARPROC address = GetProcAddress((HMODULE)library, name);
#else
    void *address = dlsym(library, name);
#endif
    if (!address || sizeof address != size) fail("no function", name);
    memcpy(function, &address, size);
}

#define CALL(function, parameters, arguments)                                          \
    do {                                                                               \
        static int(*call) parameters;                                                  \
        if (!call) find(#function, &call, sizeof call);                                \
        if (call arguments != OK) fail("refused", #function);                          \
    } while (0)

static double from_bits(uint64_t bits) {
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static uint64_t to_bits(double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static double get(const Model *model, unsigned reference) {
    double value;
    CALL(fmi2GetReal, (void *, const unsigned *, size_t, double *), (model->instance, &reference, 1, &value));
    return value;
}

static void set(const Model *model, unsigned reference, double value) {
    CALL(fmi2SetReal, (void *, const unsigned *, size_t, const double *), (model->instance, &reference, 1, &value));
}

static void make(Model *model, const char *name, const char *token) {
    static const Callbacks callbacks = {say, calloc, free, NULL, NULL};
    void *(*instantiate)(const char *, int, const char *, const char *, const Callbacks *, int, int);
    find("fmi2Instantiate", &instantiate, sizeof instantiate);
    model->instance = instantiate(name, CO_SIMULATION, token, NULL, &callbacks, 0, 0);
    if (!model->instance) fail("no instance", name);
}

static void initialise(const Model *model) {
    CALL(fmi2SetupExperiment, (void *, int, double, double, int, double), (model->instance, 0, 0.0, 0.0, 0, 0.0));
    CALL(fmi2EnterInitializationMode, (void *), (model->instance));
    CALL(fmi2ExitInitializationMode, (void *), (model->instance));
}

static void carry(const Model *source, const Model *target) {
    for (size_t wire = 0; wire < source->wire_count; wire++)
        set(target, source->to[wire], get(source, source->from[wire]));
}

static void print(const Model *model, const char *separator) {
    for (size_t output = 0; output < model->output_count; output++)
        printf("%s%016" PRIx64, output ? "," : separator, to_bits(get(model, model->outputs[output])));
}

static void advance(const Model *model, double time, double step_size) {
    CALL(fmi2DoStep, (void *, double, double, int), (model->instance, time, step_size, 1));
}

static void run(const Model *plant, const Model *controller, long steps, double step_size) {
    initialise(plant);
    initialise(controller);
    for (long step = 0; step < steps; step++) {
        double time = (double)step * step_size;
        print(plant, "");
        carry(plant, controller);
        advance(controller, time, step_size);
        print(controller, ",");
        putchar('\n');
        carry(controller, plant);
        advance(plant, time, step_size);
    }
}

int main(int count, char **arguments) {
    static Model plant, controller;
    char line[256];
    if (count != 2) fail("usage", "loop LIBRARY < script");
#ifdef _WIN32
    library = (void *)LoadLibraryA(arguments[1]);
#else
    library = dlopen(arguments[1], RTLD_NOW | RTLD_LOCAL);
#endif
    if (!library) fail("cannot load", arguments[1]);
    while (fgets(line, sizeof line, stdin)) {
        char word[8], which, name[64], token[64];
        unsigned reference, other;
        uint64_t bits;
        long number;
        Model *model;
        if (sscanf(line, "run %ld %" SCNx64, &number, &bits) == 2) {
            run(&plant, &controller, number, from_bits(bits));
            continue;
        }
        if (sscanf(line, "%7s %c", word, &which) != 2) fail("cannot read", line);
        model = which == 'p' ? &plant : &controller;
        if (sscanf(line, "make %*c %63s %63s", name, token) == 2) {
            make(model, name, token);
        } else if (sscanf(line, "real %*c %u %" SCNx64, &reference, &bits) == 2) {
            set(model, reference, from_bits(bits));
        } else if (sscanf(line, "item %*c %u %ld", &reference, &number) == 2) {
            int item = (int)number;
            CALL(fmi2SetInteger, (void *, const unsigned *, size_t, const int *), (model->instance, &reference, 1, &item));
        } else if (sscanf(line, "flag %*c %u %ld", &reference, &number) == 2) {
            int flag = (int)number;
            CALL(fmi2SetBoolean, (void *, const unsigned *, size_t, const int *), (model->instance, &reference, 1, &flag));
        } else if (sscanf(line, "wire %*c %u %u", &reference, &other) == 2 && model->wire_count < MOST) {
            model->from[model->wire_count] = reference;
            model->to[model->wire_count++] = other;
        } else if (sscanf(line, "out %*c %u", &reference) == 1 && model->output_count < MOST) {
            model->outputs[model->output_count++] = reference;
        } else {
            fail("cannot read", line);
        }
    }
    return fflush(stdout) == 0 && !ferror(stdout) ? EXIT_SUCCESS : EXIT_FAILURE;
}
