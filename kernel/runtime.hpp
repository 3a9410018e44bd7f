// What the generated code rests on: numbers, lanes of numbers, records in lanes, arrays, tuples.
//
// No header of the C++ library is needed, so that the code can be built for any target without one. Every
// operation on all lanes rounds as its counterpart on one number does.
#pragma once
#include <stdint.h>

#ifdef EXPORT  // as nothing: only the functions of FMI are to be seen
#elif defined(_WIN32)
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif
#define JOINED_(name, variant) name##_##variant
#define JOINED(name, variant) JOINED_(name, variant)
#define OF_VARIANT(name) JOINED(name, VARIANT)  // one library holds the functions for several processors
#define INLINE static inline __attribute__((always_inline))
#define OUTLINE static __attribute__((noinline))

namespace {

typedef double Vector __attribute__((ext_vector_type(LANES)));  // a number of each lane
typedef decltype(Vector() < Vector()) Whole;                    // a whole number of each lane; truth is -1 or 0

// A number of one lane: the next number of the same lane lies beyond those of the other lanes.
template <class T> struct Spaced {
    T value;
    T beside[LANES - 1];
    Spaced(const Spaced&) = delete;
    operator T() const { return value; }
    Spaced& operator=(const Spaced& x) { value = x.value; return *this; }
    Spaced& operator=(T x) { value = x; return *this; }
};

template <class A, class B> constexpr bool same = false;
template <class A> constexpr bool same<A, A> = true;
template <class T> constexpr bool in_lanes = same<T, Vector> || same<T, Whole>;
template <class T> constexpr bool is_whole = same<T, Whole> || (!in_lanes<T> && __is_integral(T));

// A number as it is kept or passed.
template <class T> INLINE auto get(const T& x) {
    if constexpr (__is_integral(T) && !same<T, bool>) return (int64_t)x;
    else return x;
}
template <class T> INLINE T get(const Spaced<T>& x) { return x.value; }
template <class T, __SIZE_TYPE__ n> INLINE T* get(T (&x)[n]) { return x; }

template <class T> INLINE Vector spread(T x) {
    if constexpr (same<T, Vector>) return x;
    else if constexpr (same<T, Whole>) return __builtin_convertvector(x, Vector);
    else return (Vector)(double)x;
}
template <class T> INLINE Whole spread_whole(T x) {
    if constexpr (same<T, Whole>) return x;
    else return (Whole)(int64_t)x;
}
template <class T> INLINE auto real(const T& x) {
    if constexpr (in_lanes<T>) return spread(x);
    else return (double)x;
}
INLINE int64_t whole(auto x) { return (int64_t)x; }
INLINE bool truth(bool x) { return x; }
INLINE Whole truth(Whole x) { return x; }
template <class T> void truth(T) = delete;  // of `a and b` Python keeps an operand: compare it, or write bool(...)

template <class C, class A, class B> INLINE auto select(C condition, A when_true, B when_false) {
    constexpr bool wide = in_lanes<C> || in_lanes<A> || in_lanes<B>;
    if constexpr (!wide) return condition ? when_true : when_false;
    else if constexpr (!in_lanes<C>) return condition ? spread(when_true) : spread(when_false);
    // A vector decides by its signs, a number of Python by being other than zero.
    else if constexpr (is_whole<A> && is_whole<B>)
        return condition != 0 ? spread_whole(when_true) : spread_whole(when_false);
    else return condition != 0 ? spread(when_true) : spread(when_false);
}
template <class A, class B> INLINE auto minimum(A a, B b) {
    if constexpr (in_lanes<A> || in_lanes<B>) return spread(a) < spread(b) ? spread(a) : spread(b);
    else return (double)a < (double)b ? (double)a : (double)b;
}
template <class A, class B> INLINE auto maximum(A a, B b) {
    if constexpr (in_lanes<A> || in_lanes<B>) return spread(a) > spread(b) ? spread(a) : spread(b);
    else return (double)a > (double)b ? (double)a : (double)b;
}
template <class A> INLINE auto sqrt(A x) {
    if constexpr (in_lanes<A>) return __builtin_elementwise_sqrt(x);
    else return __builtin_sqrt((double)x);
}
template <class A> INLINE auto floor(A x) {
    if constexpr (in_lanes<A>) return __builtin_elementwise_floor(x);
    else return __builtin_floor((double)x);
}
template <class A> INLINE auto magnitude(A x) {
    if constexpr (in_lanes<A>) return __builtin_elementwise_abs(x);
    else if constexpr (is_whole<A>) return (int64_t)(x < 0 ? -x : x);
    else return __builtin_fabs((double)x);
}
INLINE int64_t nearest_even(auto x) {
    if constexpr (is_whole<decltype(x)>) return x;
    else {
        double size = __builtin_fabs(x), nearest = size < 0x1p52 ? (size + 0x1p52) - 0x1p52 : size;
        return (int64_t)(x < 0.0 ? -nearest : nearest);
    }
}
INLINE int64_t larger(int64_t a, int64_t b) { return a > b ? a : b; }
INLINE int64_t modulo(int64_t a, int64_t b) { int64_t r = a % b; return r != 0 && (r < 0) != (b < 0) ? r + b : r; }
INLINE int64_t floor_divided(int64_t a, int64_t b) { return a / b - (a % b != 0 && (a < 0) != (b < 0)); }

// Arrays of numpy, by their shape; a row of one is an array with one dimension less.
template <class T, int D> struct Array {
    T* data;
    int64_t shape[D];
    Array& operator=(const Array&) & = default;  // not of a row or a slice: nothing would be copied
};
template <class T> constexpr bool is_record = __is_class(T);
template <class T> INLINE decltype(auto) at(T* data, int64_t i) {
    if constexpr (is_record<T>) return data + i;
    else return (data[i]);
}
template <class T, int D, class... Others> INLINE decltype(auto) at(Array<T, D> array, int64_t i, Others... others) {
    if constexpr (D == 1) return at(array.data, i);
    else {
        Array<T, D - 1> row{array.data, {}};
        int64_t size = 1;
        for (int d = 1; d < D; ++d) size *= row.shape[d - 1] = array.shape[d];
        row.data += i * size;
        if constexpr (sizeof...(others) == 0) return row;
        else return at(row, others...);
    }
}
template <int i, class T> INLINE decltype(auto) item(T* data) { return at(data, i); }
template <int i, class T, int D> INLINE decltype(auto) item(Array<T, D> array) { return at(array, i); }
template <class T, int D> INLINE int64_t len(Array<T, D> array) { return array.shape[0]; }
template <class T, __SIZE_TYPE__ n> INLINE int64_t len(T (&)[n]) { return n; }
template <class T> INLINE Array<T, 1> slice(Array<T, 1> array, int64_t from, int64_t to) { return {array.data + from, {to - from}}; }
template <class T> INLINE T* slice(T* data, int64_t from, int64_t) { return data + from; }

// Records in lanes: all lanes at once, or one of them.
template <template <class, class> class R> INLINE auto vectors(R<Vector, Whole>* block) { return block; }
template <class R> INLINE auto vectors(Array<R, 1> block) { return vectors(block.data); }
template <template <class, class> class R> INLINE auto lane(R<Vector, Whole>* block, int64_t k) {
    return (R<Spaced<double>, Spaced<int64_t>>*)((double*)block + k);
}
template <class R> INLINE auto lane(Array<R, 1> block, int64_t k) { return lane(block.data, k); }

// Tuples.
template <class A, class B> struct Tuple2 { A a; B b; };
template <class A, class B, class C> struct Tuple3 { A a; B b; C c; };
template <class A, class B, class C, class D> struct Tuple4 { A a; B b; C c; D d; };
template <class A, class B, class C, class D, class E> struct Tuple5 { A a; B b; C c; D d; E e; };
template <class A, class B, class C, class D, class E, class F> struct Tuple6 { A a; B b; C c; D d; E e; F f; };
INLINE auto tuple_of(auto a, auto b) { return Tuple2<decltype(a), decltype(b)>{a, b}; }
INLINE auto tuple_of(auto a, auto b, auto c) { return Tuple3<decltype(a), decltype(b), decltype(c)>{a, b, c}; }
INLINE auto tuple_of(auto a, auto b, auto c, auto d) {
    return Tuple4<decltype(a), decltype(b), decltype(c), decltype(d)>{a, b, c, d};
}
INLINE auto tuple_of(auto a, auto b, auto c, auto d, auto e) {
    return Tuple5<decltype(a), decltype(b), decltype(c), decltype(d), decltype(e)>{a, b, c, d, e};
}
INLINE auto tuple_of(auto a, auto b, auto c, auto d, auto e, auto f) {
    return Tuple6<decltype(a), decltype(b), decltype(c), decltype(d), decltype(e), decltype(f)>{a, b, c, d, e, f};
}
template <int i, class A> INLINE auto pick(A first, auto... others) {
    if constexpr (i == 0) return first;
    else return pick<i - 1>(others...);
}
template <int i, class... T> INLINE auto item(Tuple2<T...> t) { return pick<i>(t.a, t.b); }
template <int i, class... T> INLINE auto item(Tuple3<T...> t) { return pick<i>(t.a, t.b, t.c); }
template <int i, class... T> INLINE auto item(Tuple4<T...> t) { return pick<i>(t.a, t.b, t.c, t.d); }
template <int i, class... T> INLINE auto item(Tuple5<T...> t) { return pick<i>(t.a, t.b, t.c, t.d, t.e); }
template <int i, class... T> INLINE auto item(Tuple6<T...> t) { return pick<i>(t.a, t.b, t.c, t.d, t.e, t.f); }

// Call the step of a controller from outside; the modes of floating point, such as the rounding mode, are
// afterwards as they were before. Not inlined: no arithmetic of the model may move in between.
OUTLINE int64_t call_step_at(int64_t step, void* handle, void* inputs, void* outputs) {
#if defined(__x86_64__)
    unsigned modes = __builtin_ia32_stmxcsr();
#elif defined(__aarch64__)
    uint64_t modes;
    __asm__ volatile("mrs %0, fpcr" : "=r"(modes));
#endif
    int64_t status = ((int32_t (*)(void*, void*, void*))step)(handle, inputs, outputs);
#if defined(__x86_64__)
    __builtin_ia32_ldmxcsr(modes);
#elif defined(__aarch64__)
    __asm__ volatile("msr fpcr, %0" : : "r"(modes));
#endif
    return status;
}
}
