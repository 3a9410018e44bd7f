// What the FMU is: the file `resources/model.bin`, checked before anything in it is used.
#pragma once
#include "system.hpp"

namespace {

constexpr int64_t LARGEST_FILE = 1 << 28;  // chosen: maps of a rail have some megabytes
constexpr char FILE_NAME[] = "/model.bin";

struct Model {
    char folder[LONGEST_PATH];  // that of the resources
    uint64_t* content;          // the file, aligned as the records in it are
    const Head& head() const { return *(const Head*)content; }
    template <class T> T* section(const int64_t (&place)[2]) const { return (T*)((char*)content + place[0]); }
    const char* text(int64_t at) const { return section<char>(head().texts) + at; }
};

uint64_t checksum(const char* from, const char* to) {  // CRC-32 as in ZIP archives
    uint32_t sum = ~0u;
    for (; from < to; ++from) {
        sum ^= (uint8_t)*from;
        for (int bit = 0; bit < 8; ++bit) sum = sum >> 1 ^ (0xEDB88320u & -(sum & 1));
    }
    return ~sum;
}

bool lies_within(const int64_t (&place)[2], size_t size, int64_t end) {
    return place[0] >= (int64_t)sizeof(Head) && place[0] <= end && place[0] % 8 == 0 && place[1] >= 0
        && place[1] <= (end - place[0]) / (int64_t)size;
}

bool is_variable(const Model& model, const VariableRow& row) {
    const int64_t last = model.head().memory[1] - (row.storage == STORAGE_I4 ? 4 : 8);
    return row.name >= 0 && row.name < model.head().texts[1] && row.place >= 0 && row.place <= last && row.place % 4 == 0;
}

bool is_argument(const Head& head, const ArgumentRow& row) {
    if (row.base == BASE_NUMBER) return true;
    return row.value >= 0 && row.value < (row.base == BASE_MEMORY ? head.memory : head.constants)[1];
}

int64_t arguments_of(int64_t kind) {
    return kind == MODEL_RIG ? RIG_ARGUMENTS : kind == MODEL_BUILT_IN ? CONTROLLER_ARGUMENTS : 0;
}

int64_t size_at(int64_t place) {
    if (place == PLACE_EXCHANGE) return sizeof(Exchange);
    if (place == PLACE_COMMANDS) return sizeof(uictest_outputs);
    return place == PLACE_WHEEL_RADIUS ? sizeof uictest_config::wheel_radius : 8;
}

// Whether every place that the file names lies within it, or within the memory that it describes.
bool is_whole(const Model& model) {
    const Head& head = model.head();
    const int64_t end = head.size;
    if (!(lies_within(head.texts, 1, end) && lies_within(head.memory, 1, end) && lies_within(head.constants, 1, end)
          && lies_within(head.variables, sizeof(VariableRow), end) && lies_within(head.json, sizeof(JsonRow), end)
          && lies_within(head.arguments, sizeof(ArgumentRow), end)))
        return false;
    if (head.model < MODEL_RIG || head.model > MODEL_LIBRARY) return false;
    if (!head.texts[1] || model.text(head.texts[1] - 1)[0] || head.arguments[1] != arguments_of(head.model)) return false;
    for (int64_t n = 0; n < (int64_t)(sizeof head.places / 8); ++n) {
        const int64_t place = head.places[n];
        if (place < 0 || place % 8 || place > head.memory[1] - size_at(n)) return false;
    }
    if (head.begun < 0 || head.begun > head.memory[1] || head.kept < 0) return false;
    if (head.model == MODEL_RIG && head.kept > head.begun - head.places[PLACE_KEPT]) return false;
    for (int64_t n = 0; n < head.variables[1]; ++n)
        if (!is_variable(model, model.section<VariableRow>(head.variables)[n])) return false;
    for (int64_t n = 0; n < head.arguments[1]; ++n)
        if (!is_argument(head, model.section<ArgumentRow>(head.arguments)[n])) return false;
    for (int64_t n = 0; n < head.json[1]; ++n) {
        const JsonRow& row = model.section<JsonRow>(head.json)[n];
        if (row.text < 0 || row.text >= head.texts[1] || row.place < 0 || row.place > head.memory[1] - 8) return false;
    }
    return true;
}

// Read a file; null where it cannot be read.
uint64_t* read_file(const char* path, int64_t& size) {
    FILE* file = open_file(path);
    if (!file) return nullptr;
    uint64_t* content = nullptr;
    if (fseek(file, 0, SEEK_END) == 0 && (size = ftell(file)) >= 0 && size <= LARGEST_FILE && fseek(file, 0, SEEK_SET) == 0)
        content = (uint64_t*)calloc((size_t)size / 8 + 1, 8);
    if (content && fread(content, 1, (size_t)size, file) != (size_t)size) free(content), content = nullptr;
    fclose(file);
    return content;
}

// Read the file of the FMU; false, with the reason, where it cannot be used.
bool read_model(Model& model, const char* token, const char* resources, char* reason, size_t room) {
    char path[LONGEST_PATH + sizeof FILE_NAME];
    int64_t size = 0;
    const auto because = [&](const char* what) { return snprintf(reason, room, "%s: %s", what, path), false; };
    snprintf(path, sizeof path, "%s", resources ? resources : "nothing");
    if (!path_of(resources, model.folder)) return because("expected the folder of the FMU's resources");
    snprintf(path, sizeof path, "%s%s", model.folder, FILE_NAME);
    model.content = read_file(path, size);
    if (!model.content) return because("the file of the FMU cannot be read");
    const Head& head = model.head();
    if (size < (int64_t)sizeof(Head) || memcmp(head.magic, MAGIC, sizeof head.magic) != 0)
        return because("no file of an FMU of uictest");
    if (memcmp(head.code, CODE, sizeof head.code) != 0)
        return because("the file of the FMU is of another version of uictest than the shared library");
    const char* bytes = (const char*)model.content;
    const bool is_intact = head.size == size && head.checksum == checksum((const char*)&head.size, bytes + size);
    if (!is_intact || !is_whole(model)) return because("the file of the FMU is damaged");
    if (!token || strncmp(token, (const char*)head.token, sizeof head.token) != 0)
        return because("the file is not of the same FMU as the model description");
    return true;
}
}
