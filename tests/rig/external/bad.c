/* A controller that never brakes less, but for the fault that its parameters name. */
#include "uictest_controller.h"

#include <fenv.h>
#include <locale.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#ifndef RECORDS_AHEAD
#define RECORDS_AHEAD 0
#endif

typedef struct {
    char fault[32];
    long at;
} Controller;

static const char *no_reason = "told to";

/* Change the state of the process in the call that the fault names, as "rounding:step". */
static void leave(const char *fault, const char *call)
{
    const char *named = strchr(fault, ':');
    if (named == NULL || strcmp(named + 1, call) != 0)
        return;
    if (strncmp(fault, "rounding", 8) == 0)
        fesetround(FE_UPWARD);
#ifdef __x86_64__
    if (strncmp(fault, "subnormal", 9) == 0)
        __builtin_ia32_ldmxcsr(__builtin_ia32_stmxcsr() | 0x8040);
#endif
    if (strncmp(fault, "locale", 6) == 0)
        setlocale(LC_ALL, "C");
    if (strncmp(fault, "folder", 6) == 0 && chdir("/") != 0)
        abort();
    if (strncmp(fault, "signal", 6) == 0)
        signal(SIGTERM, SIG_IGN);
}

#ifdef ON_LOAD
__attribute__((constructor)) static void loaded(void) { leave(ON_LOAD ":load", "load"); }
#endif

#ifndef ABI
#define ABI UICTEST_ABI_VERSION
#endif

uint32_t uictest_abi_version(void) { return ABI; }
const char *uictest_version(void) { return "1.2"; }
#ifndef STATED
#define STATED "{\"fault\": {\"default\": \"none\"}, \"at\": {\"default\": 700, \"unit\": \"1\", \"range\": [0, 9999]}}"
#endif
#ifndef SILENT
const char *uictest_parameters(void) { return STATED; }
#endif

void *uictest_create(const uictest_config *config)
{
#ifdef SHARED
    static Controller of_all;
    Controller *controller = &of_all;
#else
    Controller *controller = calloc(1, sizeof *controller);
#endif
    const char *fault = strstr(config->parameters, "\"fault\": \"");
    const char *at = strstr(config->parameters, "\"at\": ");
    if (fault)
        for (int i = 0; i < 31 && fault[10 + i] != '"'; i++)
            controller->fault[i] = fault[10 + i];
    controller->at = at ? atol(at + 6) : 0;
    if (strcmp(controller->fault, "create") == 0)
        return NULL;
    leave(controller->fault, "create");
    return controller;
}

int32_t uictest_reset(void *handle)
{
    leave(((Controller *)handle)->fault, "reset");
    return strcmp(((Controller *)handle)->fault, "reset") == 0 ? 7 : 0;
}

int32_t uictest_step(void *handle, const uictest_inputs *inputs, uictest_outputs *outputs)
{
    Controller *controller = handle;
    /* What the rig notes on the controller before: guard, calling, failure, failed_wheelset, cycles. */
    if (strcmp(controller->fault, "others-guard") == 0)
        memset((char *)inputs - 40, 1, 8);
    if (inputs->cycle != controller->at)
        return 0;
    leave(controller->fault, "step");
    if (strncmp(controller->fault, "print", 5) == 0)
        printf("from C\nand more");
    if (strcmp(controller->fault, "print-crash") == 0)
        *(volatile int *)0 = 1;
    if (strcmp(controller->fault, "crash") == 0)
        *(volatile int *)0 = 1;
    if (strcmp(controller->fault, "hang") == 0)
        for (;;)
            sleep(1);
    if (strcmp(controller->fault, "exit") == 0)
        _exit(3);
    if (strncmp(controller->fault, "step", 4) == 0)
        return -1;
    if (strcmp(controller->fault, "forbidden") == 0)
        outputs->vent[1] = 1;
    if (strcmp(controller->fault, "magnet") == 0)
        outputs->hold[3] = 7;
    if (strcmp(controller->fault, "beyond") == 0)
        memset(outputs, 0, sizeof *outputs + 1);
    if (strcmp(controller->fault, "others-failure") == 0)
        memset((char *)inputs - 24, 1, 8);
    if (strcmp(controller->fault, "others-wheelset") == 0)
        memcpy((char *)inputs - 24, (int64_t[]){2, 4}, 16);
    if (strcmp(controller->fault, "others-forbidden") == 0)
        memcpy((char *)inputs - 24 + RECORDS_AHEAD, (int64_t[]){2, 1}, 16);
    if (strcmp(controller->fault, "others-calling") == 0) {
        memset((char *)inputs - 32, 1, 8);
        abort();
    }
    return 0;
}

void uictest_destroy(void *handle)
{
    if (strcmp(((Controller *)handle)->fault, "destroy") == 0)
        abort();
    leave(((Controller *)handle)->fault, "destroy");
#ifndef SHARED
    free(handle);
#endif
}

const char *uictest_last_error(void *handle)
{
    const char *fault = handle ? ((Controller *)handle)->fault : "";
    if (strcmp(fault, "step-abort") == 0)
        abort();
    if (strcmp(fault, "step-pointer") == 0)
        return (const char *)1;
    if (strcmp(fault, "step-hang") == 0)
        for (;;)
            sleep(1);
    return no_reason;
}
