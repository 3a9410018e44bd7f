// Which of the variants of the rig this processor can run: 4, 3 or 1, as the levels of x86-64 are numbered.
#ifdef EXPORT  // as nothing: only the functions of FMI are to be seen
#elif defined(_WIN32)
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif
#if defined(__x86_64__)
#include <cpuid.h>

static unsigned enabled_registers(void) {
    unsigned low, high;
    __asm__("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
    return low;
}

EXPORT int uictest_processor(void) {
    unsigned a, b, c, d;
    const unsigned fma_avx_xsave = 1u << 12 | 1u << 28 | 1u << 27 | 1u << 22 | 1u << 23 | 1u << 29;
    const unsigned avx2_bmi = 1u << 5 | 1u << 3 | 1u << 8, avx512 = 1u << 16 | 1u << 17 | 1u << 28 | 1u << 30 | 1u << 31;
    if (!__get_cpuid(1, &a, &b, &c, &d) || (c & fma_avx_xsave) != fma_avx_xsave) return 1;
    // Without LZCNT, which a virtual machine may hide, its code is run as another operation, without an error.
    if (!__get_cpuid(0x80000001, &a, &b, &c, &d) || !(c & 1u << 5)) return 1;
    unsigned registers = enabled_registers();
    if ((registers & 6) != 6 || !__get_cpuid_count(7, 0, &a, &b, &c, &d) || (b & avx2_bmi) != avx2_bmi) return 1;
    return (b & avx512) == avx512 && (registers & 0xe6) == 0xe6 ? 4 : 3;
}
#else
EXPORT int uictest_processor(void) { return 1; }
#endif
