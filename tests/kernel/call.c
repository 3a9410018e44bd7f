// Calls functions of the kernel: call CALLS RESULTS. recorded_calls.py says what the files hold.
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define NAME_(name, variant) name##_##variant
#define NAME(name, variant) NAME_(name, variant)
#define X(name) int64_t NAME(name, VARIANT)();
#include "entries.h"
#undef X
#define X(name) {#name, NAME(name, VARIANT)},
static const struct { const char *name; int64_t (*function)(); } entries[] = {
#include "entries.h"
};
enum { ENTRIES = sizeof entries / sizeof *entries, MOST = 48, CACHE_LINE = 64 };
struct head { char name[64]; int64_t blocks, arguments; };
struct argument { int64_t block, number; };  // a place in a block of memory; or, below zero, a number

static int64_t call(int64_t (*function)(), const int64_t *a) {  // the callee leaves alone what it does not take
#define SIX(n) a[n], a[n + 1], a[n + 2], a[n + 3], a[n + 4], a[n + 5]
    return function(SIX(0), SIX(6), SIX(12), SIX(18), SIX(24), SIX(30), SIX(36), SIX(42));
}

static void require(int met, const char *what) {
    if (met) return;
    fprintf(stderr, "call: %s\n", what);
    exit(1);
}

int main(int count, char **names) {
    require(count == 3, "expected CALLS RESULTS");
    FILE *calls = fopen(names[1], "rb"), *results = fopen(names[2], "wb");
    require(calls && results, "a file cannot be opened");
    struct head head;
    while (fread(&head, sizeof head, 1, calls) == 1) {
        int64_t sizes[MOST], given[MOST] = {0};
        struct argument arguments[MOST];
        char *memory[MOST], *blocks[MOST];
        require(head.blocks <= MOST && head.arguments <= MOST, "too many arguments");
        require(fread(sizes, sizeof *sizes, head.blocks, calls) == head.blocks, "the file is cut");
        require(fread(arguments, sizeof *arguments, head.arguments, calls) == head.arguments, "the file is cut");
        for (int n = 0; n < head.blocks; n++) {
            memory[n] = malloc(sizes[n] + CACHE_LINE);
            blocks[n] = (char *)(((intptr_t)memory[n] + CACHE_LINE - 1) & -CACHE_LINE);
            require(fread(blocks[n], 1, sizes[n], calls) == sizes[n], "the file is cut");
        }
        for (int n = 0; n < head.arguments; n++) {
            given[n] = arguments[n].number;
            if (arguments[n].block >= 0) given[n] += (intptr_t)blocks[arguments[n].block];
        }
        int entry = 0;
        while (entry < ENTRIES && strcmp(entries[entry].name, head.name) != 0) entry++;
        require(entry < ENTRIES, head.name);
        int64_t result = call(entries[entry].function, given);
        fwrite(&result, sizeof result, 1, results);
        for (int n = 0; n < head.blocks; n++) {
            fwrite(blocks[n], 1, sizes[n], results);
            free(memory[n]);
        }
    }
    return fclose(results) != 0;
}
