// What an instance is of: the rig of a case, a built-in controller, or a controller in a library of its own.
#pragma once
#include "instance.hpp"

namespace {

// Call the machine code with what the file says: numbers, and places in the memory or among the constants.
int64_t call(Instance* instance) {
    const Head& head = instance->model.head();
    const ArgumentRow* rows = instance->model.section<ArgumentRow>(head.arguments);
    int64_t given[RIG_ARGUMENTS > CONTROLLER_ARGUMENTS ? RIG_ARGUMENTS : CONTROLLER_ARGUMENTS];
    for (int64_t n = 0; n < head.arguments[1]; ++n) {
        const int64_t value = rows[n].value;
        if (rows[n].base == BASE_NUMBER) given[n] = value;
        else if (rows[n].base == BASE_MEMORY) given[n] = (int64_t)instance->at<char>(value);
        else given[n] = (int64_t)(instance->model.section<char>(head.constants) + value);
    }
    return head.model == MODEL_RIG ? step_rig(given) : decide_alone(given);
}

// The rig. Zeroed but for its parameters, the memory of a stop is one that has not begun.

void begin(Instance* instance) {
    const Head& head = instance->model.head();
    if (head.model != MODEL_RIG) return;
    const int64_t kept = head.places[PLACE_KEPT];
    memset(instance->at<char>(0), 0, (size_t)kept);
    memset(instance->at<char>(kept + head.kept), 0, (size_t)(head.begun - kept - head.kept));
    call(instance);
}

bool has_ended(Instance* instance) { return instance->value<double>(PLACE_CLOSED) != 0.0; }

int carry_out_rig(Instance* instance) {
    if (has_ended(instance)) return 1;
    Exchange* exchange = &instance->value<Exchange>(PLACE_EXCHANGE);
    const uictest_outputs& commands = instance->value<uictest_outputs>(PLACE_COMMANDS);
    memcpy((char*)exchange + sizeof(uictest_inputs), &commands, sizeof commands);
    call(instance);
    const int number = (int)exchange->failed_wheelset;
    if (exchange->failure == FORBIDDEN_COMMAND)
        return fail(instance, "vent_%d without hold_%d is forbidden: both are true in order to vent", number + 1, number + 1);
    if (exchange->failure == NO_REDUCTION)
        return fail(instance, "dynamic_reduction_%d is %g, expected 0 to 1", number + 1, commands.dynamic_reduction[number & 3]);
    if (exchange->failure != NO_FAILURE) return fail(instance, "a command is none that the rig has");
    instance->value<int64_t>(PLACE_ENDED) = has_ended(instance);
    return 1;
}

// A controller.

bool load(Program& program, const char* folder, char* reason, size_t room) {
    char path[LONGEST_PATH + sizeof CONTROLLER_FILE], why[300];
    snprintf(path, sizeof path, "%s%s", folder, CONTROLLER_FILE);
    program.library = open_library(path, why, sizeof why);
    if (!program.library) return snprintf(reason, room, "the controller cannot be loaded: %s", why), false;
    const char* names[] = {"create", "reset", "step", "destroy", "last_error"};
    void** functions = (void**)&program.create;
    for (size_t n = 0; n < 5; ++n) {
        snprintf(path, sizeof path, "uictest_%s", names[n]);
        functions[n] = symbol(program.library, path);
        if (!functions[n]) return snprintf(reason, room, "the controller has no function %s", path), false;
    }
    return true;
}

int failed(Instance* instance, const char* function) {
    const char* reason = instance->program.last_error(instance->program.controller);
    return fail(instance, "%s failed: %s", function, reason && *reason ? reason : "no reason given");
}

// Write the parameters as the JSON object that a controller is given, 17 digits keep every bit; return its length.
size_t write_json(Instance* instance, char* json, size_t room) {
    const Head& head = instance->model.head();
    const JsonRow* rows = instance->model.section<JsonRow>(head.json);
    size_t length = 0;
    const auto write = [&](const char* text) {
        for (; *text; ++text, ++length)
            if (length + 1 < room) json[length] = *text;
    };
    write("{");
    for (int64_t n = 0; n < head.json[1]; ++n) {
        const double value = *instance->at<double>(rows[n].place);
        char number[40];
        snprintf(number, sizeof number, "%.17g", value);
        write(n ? ", " : "");
        write(instance->model.text(rows[n].text));
        write(rows[n].form == FORM_FIXED ? "" : rows[n].form == FORM_NUMBER ? number : value != 0.0 ? "true" : "false");
    }
    write("}");
    if (room) json[length] = 0;
    return length;
}

int create(Instance* instance) {
    Program& program = instance->program;
    const size_t room = write_json(instance, nullptr, 0) + 1;
    char* json = (char*)malloc(room);
    if (!json) return fail(instance, "there is no memory for the parameters");
    write_json(instance, json, room);
    uictest_config config = {UICTEST_WHEELSETS, 0, instance->cycle_time(), instance->value<double>(PLACE_INITIAL_SPEED), {}, json};
    memcpy(config.wheel_radius, &instance->value<double>(PLACE_WHEEL_RADIUS), sizeof config.wheel_radius);
    program.controller = program.create(&config);
    free(json);
    if (!program.controller) return failed(instance, "uictest_create");
    return program.reset(program.controller) == 0 || failed(instance, "uictest_reset");
}

int complete(Instance* instance) {
    if (instance->model.head().model != MODEL_LIBRARY) return 1;
    PlainNumbers here;
    return create(instance);
}

int carry_out(Instance* instance) {
    const int64_t model = instance->model.head().model;
    if (model == MODEL_RIG) return carry_out_rig(instance);
    Exchange* exchange = &instance->value<Exchange>(PLACE_EXCHANGE);
    void* outputs = (char*)exchange + sizeof(uictest_inputs);
    exchange->cycle = instance->state->steps;
    exchange->time = (double)instance->state->steps * instance->cycle_time();
    memset(outputs, 0, sizeof(uictest_outputs));
    exchange->reference_speed = NAN;
    if (model == MODEL_BUILT_IN) return call(instance), 1;
    const Program& program = instance->program;
    return program.step(program.controller, exchange, outputs) == 0 || failed(instance, "uictest_step");
}

void release(Instance* instance) {
    if (instance->program.controller) instance->program.destroy(instance->program.controller);
    instance->program.controller = nullptr;
}
}
