// Eight floats at a time, and their logarithm and exponential: plain arithmetic of the compiler's
// vectors, so that every machine does the same operations in the same order and gives the same
// bytes.
#pragma once

#include <cstdint>

namespace beckon::pose::lanes {

inline constexpr int kLanes = 8;
typedef float Lanes __attribute__((vector_size(kLanes * sizeof(float))));
typedef int32_t IntLanes __attribute__((vector_size(kLanes * sizeof(int32_t))));

#define BECKON_LANES_INLINE [[gnu::always_inline]] inline

BECKON_LANES_INLINE Lanes All(float value) { return Lanes{} + value; }
BECKON_LANES_INLINE Lanes Max(Lanes a, Lanes b) { return a > b ? a : b; }
BECKON_LANES_INLINE Lanes Min(Lanes a, Lanes b) { return a < b ? a : b; }

BECKON_LANES_INLINE Lanes Abs(Lanes x) {
  return reinterpret_cast<Lanes>(reinterpret_cast<IntLanes>(x) & 0x7fffffff);
}

/// |magnitude| with the sign of `sign`.
BECKON_LANES_INLINE Lanes CopySign(Lanes magnitude, Lanes sign) {
  return reinterpret_cast<Lanes>((reinterpret_cast<IntLanes>(magnitude) & 0x7fffffff) |
                                 (reinterpret_cast<IntLanes>(sign) & INT32_MIN));
}

BECKON_LANES_INLINE Lanes Sqrt(Lanes x) {
  Lanes root;
  for (int i = 0; i < kLanes; ++i) root[i] = __builtin_sqrtf(x[i]);
  return root;
}

/// Natural logarithm of normal numbers > 0, to 1e-7 relative (Moshier, Cephes: logf).
BECKON_LANES_INLINE Lanes Log(Lanes x) {
  const IntLanes bits = reinterpret_cast<IntLanes>(x);
  IntLanes exponent = (bits >> 23) - 127;
  Lanes m = reinterpret_cast<Lanes>((bits & 0x007fffff) | 0x3f800000);  // 1 <= m < 2
  const IntLanes high = m > 1.41421356f;
  m = high ? 0.5f * m : m;
  exponent -= high;  // a true lane is -1
  const Lanes e = __builtin_convertvector(exponent, Lanes);
  const Lanes r = m - 1.0f, r2 = r * r;
  Lanes y = 7.0376836292e-2f * r - 1.1514610310e-1f;
  y = y * r + 1.1676998740e-1f;
  y = y * r - 1.2420140846e-1f;
  y = y * r + 1.4249322787e-1f;
  y = y * r - 1.6668057665e-1f;
  y = y * r + 2.0000714765e-1f;
  y = y * r - 2.4999993993e-1f;
  y = y * r + 3.3333331174e-1f;
  y = y * r * r2 - 2.12194440e-4f * e - 0.5f * r2;
  return r + y + 0.693359375f * e;
}

/// Exponential, to 1e-7 relative; the argument is clamped to +-87 (Moshier, Cephes: expf).
BECKON_LANES_INLINE Lanes Exp(Lanes x) {
  x = Min(Max(x, All(-87.0f)), All(87.0f));
  const Lanes scaled = 1.44269504f * x;
  const IntLanes n = __builtin_convertvector(scaled + CopySign(All(0.5f), scaled), IntLanes);
  const Lanes k = __builtin_convertvector(n, Lanes);
  x = x - k * 0.693359375f + k * 2.12194440e-4f;
  Lanes y = 1.9875691500e-4f * x + 1.3981999507e-3f;
  y = y * x + 8.3334519073e-3f;
  y = y * x + 4.1665795894e-2f;
  y = y * x + 1.6666665459e-1f;
  y = y * x + 5.0000001201e-1f;
  y = y * x * x + x + 1.0f;
  return y * reinterpret_cast<Lanes>((n + 127) << 23);
}

}  // namespace beckon::pose::lanes
