// The phases of an instance, from its creation to its end, and its variables in them.
#pragma once
#include "behaviour.hpp"

namespace {

// Share of a cycle by which time may differ from whole cycles; chosen: far above what adding up cycles as
// floating-point numbers loses.
constexpr double TOLERANCE = 1e-3;

void reset(Instance* instance) {
    release(instance);
    const Head& head = instance->model.head();
    memset(instance->state, 0, sizeof(State));
    memcpy(instance->at<char>(0), instance->model.section<char>(head.memory), (size_t)head.memory[1]);
}

void destroy(Instance* instance) {
    if (!instance) return;
    if (instance->state) release(instance);
    if (instance->program.library) close_library(instance->program.library);
    free(instance->state), free(instance->model.content), free(instance->name), free(instance);
}

// Complete an instance that knows its caller; null, with a report, where it cannot be one.
Instance* instantiate(Instance* instance, const char* name, const char* token, const char* resources) {
    name = name ? name : "";
    instance->name = (char*)malloc(strlen(name) + 1);
    if (instance->name) strcpy(instance->name, name);
    const auto complete_it = [&] {
        char (&message)[sizeof instance->message] = instance->message;
        Model& model = instance->model;
        if (!read_model(model, token, resources, message, sizeof message)) return false;
        if (model.head().model == MODEL_LIBRARY && !load(instance->program, model.folder, message, sizeof message)) return false;
        instance->state = (State*)calloc(1, instance->size());
        return instance->state && instance->name ? true : (fail(instance, "there is no memory"), false);
    };
    if (complete_it()) return reset(instance), instance;
    instance->report(instance);
    destroy(instance);
    return nullptr;
}

int enter_initialization(Instance* instance, double start_time) {
    State& state = *instance->state;
    if (state.phase != INSTANTIATED)
        return fail(instance, "initialization can only be entered once, after instantiation or reset");
    instance->value<double>(PLACE_TIME) = state.start_time = start_time;
    state.phase = INITIALIZING;
    begin(instance);
    return 1;
}

int exit_initialization(Instance* instance) {
    if (instance->state->phase != INITIALIZING)
        return fail(instance, "initialization can only be left after it was entered");
    if (!complete(instance)) return 0;
    instance->state->phase = STEPPING;
    return 1;
}

// Carry out one controller cycle from a communication point on.
int step(Instance* instance, double communication_point, double step_size) {
    const double cycle = instance->cycle_time(), now = instance->time();
    if (instance->state->phase != STEPPING)
        return fail(instance, "a step can only be taken between initialization and termination");
    if (!(fabs(step_size - cycle) <= TOLERANCE * cycle))
        return fail(instance, "the communication step is %g s; it must be the controller cycle, %g s", step_size, cycle);
    if (!(fabs(communication_point - now) <= TOLERANCE * cycle))
        return fail(instance, "the communication point is %g s; the last step ended at %g s", communication_point, now);
    if (!carry_out(instance)) return 0;
    instance->state->steps += 1;
    instance->value<double>(PLACE_TIME) = instance->time();
    return 1;
}

const VariableRow* variable(Instance* instance, uint32_t reference, int64_t kind) {
    const Head& head = instance->model.head();
    const VariableRow* rows = instance->model.section<VariableRow>(head.variables);
    if (reference < head.variables[1] && rows[reference].kind == kind) return rows + reference;
    fail(instance, "no variable of this type has the value reference %u", (unsigned)reference);
    return nullptr;
}

int get_value(Instance* instance, uint32_t reference, int64_t kind, double& value) {
    const VariableRow* found = variable(instance, reference, kind);
    if (!found) return 0;
    if (found->storage == STORAGE_F8) value = *instance->at<double>(found->place);
    else if (found->storage == STORAGE_I4) value = *instance->at<int32_t>(found->place);
    else value = (double)*instance->at<int64_t>(found->place);
    return 1;
}

int set_value(Instance* instance, uint32_t reference, int64_t kind, double value) {
    const VariableRow* found = variable(instance, reference, kind);
    const bool before_steps = instance->state->phase == INSTANTIATED || instance->state->phase == INITIALIZING;
    if (!found) return 0;
    if (kind == KIND_BOOLEAN) value = value != 0.0;
    const bool is_parameter = found->causality == CAUSALITY_PARAMETER;
    if (!is_parameter && found->causality != CAUSALITY_INPUT)
        return fail(instance, "the variable with value reference %u cannot be set", (unsigned)reference);
    if (is_parameter && !before_steps)
        return fail(instance, "a parameter can only be set before the end of the initialization");
    if (is_parameter && !(value >= found->lowest && value <= found->highest))
        return fail(instance, "%s is %.15g, expected a number from %.15g to %.15g", instance->model.text(found->name),
                    value, found->lowest, found->highest);
    if (found->storage == STORAGE_F8) *instance->at<double>(found->place) = value;
    else if (found->storage == STORAGE_I4) *instance->at<int32_t>(found->place) = (int32_t)value;
    else *instance->at<int64_t>(found->place) = (int64_t)value;
    if (is_parameter && instance->state->phase == INITIALIZING) begin(instance);
    return 1;
}
}
