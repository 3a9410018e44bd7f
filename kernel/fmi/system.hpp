// What differs between systems: files whose names are UTF-8, shared libraries, the language of numbers.
#pragma once
#include <locale.h>
#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#ifdef _WIN32
#include <windows.h>
#define EXPORT __declspec(dllexport)
#else
#include <dlfcn.h>
#define EXPORT __attribute__((visibility("default")))
#endif

namespace {

constexpr size_t LONGEST_PATH = 4096;  // chosen
#ifdef _WIN32
constexpr char CONTROLLER_FILE[] = "/x86_64-windows/controller.dll";
#elif defined(__aarch64__)
constexpr char CONTROLLER_FILE[] = "/aarch64-linux/controller.so";
#else
constexpr char CONTROLLER_FILE[] = "/x86_64-linux/controller.so";
#endif

#ifdef _WIN32
typedef HMODULE Library;

struct Wide {
    wchar_t text[LONGEST_PATH];
    explicit Wide(const char* utf8) {
        if (!MultiByteToWideChar(CP_UTF8, 0, utf8, -1, text, LONGEST_PATH)) text[0] = 0;
        for (wchar_t* each = text; *each; ++each)
            if (*each == L'/') *each = L'\\';
    }
};
FILE* open_file(const char* path) { return _wfopen(Wide(path).text, L"rb"); }
Library open_library(const char* path, char* reason, size_t size) {
    // What the library needs and what lies beside it is found there, too.
    Library library = LoadLibraryExW(Wide(path).text, nullptr, LOAD_WITH_ALTERED_SEARCH_PATH);
    if (!library) snprintf(reason, size, "%s: error %lu of Windows", path, GetLastError());
    return library;
}
void* symbol(Library library, const char* name) { return (void*)GetProcAddress(library, name); }
void close_library(Library library) { FreeLibrary(library); }

// While it lives, numbers have a decimal point in this thread, whatever the language of the program.
struct PlainNumbers {
    int threads = _configthreadlocale(_ENABLE_PER_THREAD_LOCALE);
    char before[100] = "C";
    PlainNumbers() {
        if (const char* name = setlocale(LC_NUMERIC, nullptr)) snprintf(before, sizeof before, "%s", name);
        setlocale(LC_NUMERIC, "C");
    }
    ~PlainNumbers() { setlocale(LC_NUMERIC, before), _configthreadlocale(threads); }
};
#else
typedef void* Library;

FILE* open_file(const char* path) { return fopen(path, "rb"); }
Library open_library(const char* path, char* reason, size_t size) {
    Library library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (!library) snprintf(reason, size, "%s", dlerror());
    return library;
}
void* symbol(Library library, const char* name) { return dlsym(library, name); }
void close_library(Library library) { dlclose(library); }

struct PlainNumbers {
    locale_t plain = newlocale(LC_NUMERIC_MASK, "C", (locale_t)0), before = uselocale(plain);
    ~PlainNumbers() { uselocale(before), freelocale(plain); }
};
#endif

int digit(char sign) {
    const char *digits = "0123456789abcdef", *found = sign ? strchr(digits, sign | (sign > '9' ? 32 : 0)) : nullptr;
    return found ? (int)(found - digits) : -1;
}

// Find the path of a folder that is given as one (FMI 3.0) or as a URI (FMI 2.0); false where it is neither.
bool path_of(const char* location, char (&path)[LONGEST_PATH]) {
    if (!location || strlen(location) >= LONGEST_PATH - sizeof CONTROLLER_FILE) return false;
    const bool is_uri = strncmp(location, "file:", 5) == 0;
    if (is_uri) {
        location += 5;
        if (strncmp(location, "//localhost/", 12) == 0) location += 11;
        else if (strncmp(location, "///", 3) == 0) location += 2;
#ifdef _WIN32
        if (location[0] == '/' && location[1] && location[2] == ':') ++location;  // /C:/... is C:/...
#endif
    }
    char* end = path;
    for (; *location; ++location) {
        const bool is_coded = is_uri && *location == '%' && digit(location[1]) >= 0 && digit(location[2]) >= 0;
        *end++ = is_coded ? (char)(digit(location[1]) * 16 + digit(location[2])) : *location;
        if (is_coded) location += 2;
    }
    while (end > path && (end[-1] == '/' || end[-1] == '\\')) --end;
    *end = 0;
    return end > path;
}
}
