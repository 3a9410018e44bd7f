/* Any WSP controller in C as a program of its own: uictest connects and asks for one answer per cycle.
 *
 *     gcc -O2 -ffp-contract=off -IFOLDER -o wsp serve.c wsp.c -lm && ./wsp 5025
 *
 * FOLDER is that of uictest_controller.h. Put your own controller, of either version, in the place of wsp.c. With
 * port 0 the system chooses one. One connection is served at a time. Frames, little-endian: docs/socket.md. */
#define UICTEST_ABI_VERSION 2                                  /* version 1 has the first part of its memory */
#include "uictest_controller.h"

#include <arpa/inet.h>
#include <math.h>
#include <netinet/tcp.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

enum { LARGEST_BODY = 65536, LARGEST_ANSWER = 1000, INPUTS_1 = 104, OUTPUTS_1 = 48 };

typedef struct { char kind[4]; uint32_t size; uint64_t number; } header;
typedef struct {                                               /* the parameters follow as JSON */
    uint32_t version, inputs_size, outputs_size, wheelsets;
    double cycle_time, initial_speed, wheel_radius[UICTEST_WHEELSETS];
    uint8_t case_sha256[32];
} greeting;
typedef struct { uint32_t version; char name[60]; } program;

static header head;                                            /* of the frame that came last */
static union { greeting greeting; uictest_inputs inputs; char bytes[LARGEST_BODY + 1]; } body;
static void *controller;
const char *uictest_version(void) __attribute__((weak));       /* a controller may leave it out */

static int receive(int stream, void *memory, size_t size) {
    return size == 0 || recv(stream, memory, size, MSG_WAITALL) == (ssize_t)size;
}

static int answer(int stream, const void *content, size_t size) {
    struct { header head; char content[LARGEST_ANSWER]; } frame = {.head = head};
    frame.head.size = (uint32_t)size;
    memcpy(frame.content, content, size);
    return send(stream, &frame, sizeof head + size, 0) > 0;
}

static int fail(int stream, const char *reason) {
    memcpy(head.kind, "FAIL", 4);
    return reason == NULL ? answer(stream, "", 0) : answer(stream, reason, strnlen(reason, LARGEST_ANSWER));
}

static int create(int stream) {
    const greeting *given = &body.greeting;
    uictest_config config = {UICTEST_WHEELSETS, 0, given->cycle_time, given->initial_speed, {0}, NULL};
    program own = {uictest_abi_version(), ""};
    int known = given->version == 1 && given->inputs_size == INPUTS_1 && given->outputs_size == OUTPUTS_1;
    if (head.size < sizeof *given || !known) return fail(stream, "expected protocol version 1");
    memcpy(config.wheel_radius, given->wheel_radius, sizeof config.wheel_radius);
    body.bytes[head.size] = '\0';
    config.parameters = body.bytes + sizeof *given;
    controller = uictest_create(&config);
    if (controller == NULL) return fail(stream, uictest_last_error(NULL));
    if (uictest_version) snprintf(own.name, sizeof own.name, "%s", uictest_version());
    return answer(stream, &own, sizeof own);
}

static int step(int stream) {
    uictest_outputs out = {.reference_speed = NAN};
    int32_t status = uictest_step(controller, &body.inputs, &out);
    if (status) return fail(stream, uictest_last_error(controller));
    return answer(stream, &out, uictest_abi_version() > 1 ? sizeof out : OUTPUTS_1);
}

static int serve(int stream) {                                 /* 0: the stop is over */
    if (memcmp(head.kind, "HELO", 4) == 0 && controller == NULL) return create(stream);
    if (memcmp(head.kind, "STEP", 4) == 0 && controller != NULL) return step(stream);
    if (memcmp(head.kind, "RSET", 4) != 0 || controller == NULL) return 0;
    return uictest_reset(controller) ? fail(stream, uictest_last_error(controller)) : answer(stream, "", 0);
}

int main(int count, char **arguments) {
    struct sockaddr_in at = {.sin_family = AF_INET, .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
    socklen_t size = sizeof at;
    int yes = 1, listener = socket(AF_INET, SOCK_STREAM, 0);
    signal(SIGPIPE, SIG_IGN);
    at.sin_port = htons((uint16_t)atoi(count > 1 ? arguments[1] : "5025"));
    setsockopt(listener, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    if (bind(listener, (void *)&at, size) || listen(listener, 8)) return perror("serve"), 1;
    getsockname(listener, (void *)&at, &size);
    printf("listening on tcp://127.0.0.1:%d\n", ntohs(at.sin_port)), fflush(stdout);
    for (;;) {                                                 /* one connection per stop */
        int stream = accept(listener, NULL, NULL);
        setsockopt(stream, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
        while (receive(stream, &head, sizeof head) && head.size <= LARGEST_BODY
               && receive(stream, &body, head.size) && serve(stream)) {}
        if (controller != NULL) uictest_destroy(controller);
        controller = NULL;
        close(stream);
    }
}
