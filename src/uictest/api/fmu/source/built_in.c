/* A built-in controller behind uictest_controller.h: its machine code, which is linked with this file. */
#include "memory.h"
#include "uictest_controller.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct {
    const char *key;
    size_t offset;
} PARAMETERS[] = {PARAMETER_ROWS};

int64_t FUNCTION(int64_t memory, int64_t inputs, int64_t outputs); /* without inputs it begins a stop */

uint32_t uictest_abi_version(void) { return UICTEST_ABI_VERSION; }

void *uictest_create(const uictest_config *config)
{
    unsigned char *memory = calloc(1, MEMORY_SIZE);
    if (memory == NULL)
        return NULL;
    for (size_t i = 0; i < sizeof PARAMETERS / sizeof *PARAMETERS; i++) {
        const char *place = strstr(config->parameters, PARAMETERS[i].key);
        double value = place == NULL ? 0.0 : strtod(place + strlen(PARAMETERS[i].key), NULL);
        memcpy(memory + PARAMETERS[i].offset, &value, sizeof value);
    }
    memcpy(memory + CYCLE_TIME_AT, &config->cycle_time, sizeof config->cycle_time);
    memcpy(memory + INITIAL_SPEED_AT, &config->initial_speed, sizeof config->initial_speed);
    return memory;
}

int32_t uictest_reset(void *controller)
{
    memset(controller, 0, REMEMBERED_SIZE);
    return (int32_t)FUNCTION((int64_t)controller, 0, 0);
}

int32_t uictest_step(void *controller, const uictest_inputs *inputs, uictest_outputs *outputs)
{
    return (int32_t)FUNCTION((int64_t)controller, (int64_t)inputs, (int64_t)outputs);
}

void uictest_destroy(void *controller) { free(controller); }

const char *uictest_last_error(void *controller) { return controller == NULL ? "there is no memory" : ""; }
