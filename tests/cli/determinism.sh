# Threads, locale, time zone, folder, umask and processor do not change the bytes.
. "$(dirname "$0")/lib.sh"
"$RELIEF_SOURCE/tests/long/determinism.sh" --quick

# Library random numbers, functions whose last bits vary, and clocks must not reach outputs: portable_math.cpp replaces
# the functions. Benchmarks, stopwatches (std::chrono) and progress bars reach none.
found=$(cd "$RELIEF_SOURCE" && grep -nE \
    'std::(sin|cos|tan|asin|acos|atan|atan2|sinh|cosh|tanh|exp|exp2|expm1|log|log2|log10|log1p|pow|hypot|cbrt|tgamma|lgamma|erf|erfc)\(|(uniform_(int|real)|normal|bernoulli|poisson|discrete)_distribution|random_device|random_shuffle|std::(shuffle|sample)\(|unordered_(map|set)|std::hash|__DATE__|__TIME__|std::time\(|system_clock|setlocale|-ffast-math|-march=|rtcNewDevice\(nullptr' \
    bake/*.cpp bake/*.h bake/CMakeLists.txt formats/*.cpp formats/*.h formats/CMakeLists.txt CMakeLists.txt |
    grep -vE '^bake/bench_|//.*libm' || true)
[ -z "$found" ] || die "bits that vary from machine to machine may reach outputs; use portable_math.h and surface_sampler.h:"$'\n'"$found"
grep -q -- '-ffp-contract=off' "$RELIEF_SOURCE/CMakeLists.txt" || die "contraction is not off"
