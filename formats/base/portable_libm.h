// For a file whose templates call libm: there acos, cos and sin become the functions of portable_math.h, by
// the names that the linker sees. Must be included before any other header, and the file be compiled with
// -fno-builtin: sine and cosine of one angle would become one call of libm. portable_math.cpp holds what is
// called.
#pragma once

extern "C" {
double acos(double) noexcept __asm__("relief_portable_acos");
double cos(double) noexcept __asm__("relief_portable_cos");
double sin(double) noexcept __asm__("relief_portable_sin");
}
