/* A controller that never brakes less, but for the fault that its parameters name. */
#include "uictest_controller.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct {
    char fault[32];
    long at;
} Controller;

static const char *no_reason = "told to";

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
    Controller *controller = calloc(1, sizeof *controller);
    const char *fault = strstr(config->parameters, "\"fault\": \"");
    const char *at = strstr(config->parameters, "\"at\": ");
    if (fault)
        for (int i = 0; i < 31 && fault[10 + i] != '"'; i++)
            controller->fault[i] = fault[10 + i];
    controller->at = at ? atol(at + 6) : 0;
    if (strcmp(controller->fault, "create") == 0)
        return NULL;
    return controller;
}

int32_t uictest_reset(void *handle) { return strcmp(((Controller *)handle)->fault, "reset") == 0 ? 7 : 0; }

int32_t uictest_step(void *handle, const uictest_inputs *inputs, uictest_outputs *outputs)
{
    Controller *controller = handle;
    if (inputs->cycle != controller->at)
        return 0;
    if (strcmp(controller->fault, "crash") == 0)
        *(volatile int *)0 = 1;
    if (strcmp(controller->fault, "hang") == 0)
        for (;;)
            sleep(1);
    if (strcmp(controller->fault, "exit") == 0)
        _exit(3);
    if (strcmp(controller->fault, "step") == 0)
        return -1;
    if (strcmp(controller->fault, "forbidden") == 0)
        outputs->vent[1] = 1;
    if (strcmp(controller->fault, "magnet") == 0)
        outputs->hold[3] = 7;
    if (strcmp(controller->fault, "beyond") == 0)
        memset(outputs, 0, sizeof *outputs + 1);
    return 0;
}

void uictest_destroy(void *handle)
{
    if (strcmp(((Controller *)handle)->fault, "destroy") == 0)
        abort();
    free(handle);
}

const char *uictest_last_error(void *handle) { (void)handle; return no_reason; }
