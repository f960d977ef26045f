// For a file whose templates call libm: the linker gives it portable_math.h's acos, cos and sin instead. Include it
// before any other header, and compile the file with -fno-builtin, or the compiler makes sine and cosine of one angle
// one call of libm. portable_math.cpp defines the functions.
#pragma once

extern "C" {
double acos(double) noexcept __asm__("relief_portable_acos");
double cos(double) noexcept __asm__("relief_portable_cos");
double sin(double) noexcept __asm__("relief_portable_sin");
}
