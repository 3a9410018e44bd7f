// An instance behind the functions of FMI: the file that it was made from, its memory, its caller.
#pragma once
#include "model.hpp"

namespace {

enum Phase : int64_t { INSTANTIATED, INITIALIZING, STEPPING, TERMINATED };

// Everything that changes in a simulation, in front of the memory of the model. Where the model says that it can
// be saved there is no address in it: a copy is a copy of the simulation.
struct State {
    int64_t phase, steps;  // steps since start_time
    double start_time;
};

// A controller in a library of its own, behind uictest_controller.h.
struct Program {
    Library library;
    void* (*create)(const uictest_config*);
    int32_t (*reset)(void*);
    int32_t (*step)(void*, const void*, void*);
    void (*destroy)(void*);
    const char* (*last_error)(void*);
    void* controller;  // null where there is none
};

struct Instance {
    Model model;
    State* state;
    Program program;
    char message[400];  // why the last function failed
    char* name;
    void* environment;  // of the caller, for its logger
    void* logger;
    void (*report)(const Instance*);

    size_t size() const { return sizeof(State) + (size_t)model.head().memory[1]; }
    template <class T> T* at(int64_t place) { return (T*)((char*)(state + 1) + place); }
    template <class T> T& value(int64_t place) { return *at<T>(model.head().places[place]); }
    double cycle_time() { return value<double>(PLACE_CYCLE_TIME); }
    double time() { return state->start_time + (double)state->steps * cycle_time(); }
};

// Functions that return int return 1, or 0 with a message.
__attribute__((format(printf, 2, 3))) int fail(Instance* instance, const char* format, ...) {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(instance->message, sizeof instance->message, format, arguments);
    va_end(arguments);
    return 0;
}
}
