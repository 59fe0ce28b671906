// SPDX-License-Identifier: GPL-3.0-or-later
// A fuzzer's input, spelled as arguments of the C API.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fuzzer/FuzzedDataProvider.h>
#include <limits>
#include <string>

namespace glimmer {

constexpr size_t kMostElements = 12; // of the arrays handed in
constexpr uint32_t kMostSide = 40;   // pixels of the pictures rendered

/// Values from the edges of every range, and ordinary ones so that what follows has a chance.
class Input : public FuzzedDataProvider {
  public:
    using FuzzedDataProvider::FuzzedDataProvider;

    /// Half of them from the edges.
    double number() {
        constexpr double infinity = std::numeric_limits<double>::infinity();
        constexpr std::array edges{0.0,
                                   -0.0,
                                   1.0,
                                   -1.0,
                                   0.5,
                                   1e-30,
                                   1e-320,
                                   1e30,
                                   1e300,
                                   180.0,
                                   -1e5,
                                   1e-45,
                                   3e38,
                                   1e38,
                                   1e19,
                                   1e9,
                                   infinity,
                                   -infinity,
                                   std::numeric_limits<double>::quiet_NaN(),
                                   90.0};
        if (ConsumeBool())
            return PickValueInArray(edges);
        return ConsumeFloatingPointInRange<double>(-4, 4);
    }
    float single() { return static_cast<float>(std::clamp(number(), -3.4e38, 3.4e38)); }
    template <class T>
    void fill(T *values, size_t count) {
        for (size_t i = 0; i < count; ++i)
            values[i] = static_cast<T>(ConsumeIntegralInRange<int>(0, 7) ? single() : number());
    }
    uint32_t index() { return ConsumeBool() ? ConsumeIntegralInRange<uint32_t>(0, 8) : integer(); }
    uint32_t integer() {
        constexpr std::array<uint32_t, 8> edges{0, 1, 2, 3, 0x7fffffff, 0x80000000, 0xfffffff0, 0xffffffff};
        return PickValueInArray(edges);
    }
    /// Of an enumeration, or one beyond either end.
    template <class E>
    E choice(int most) {
        int value = ConsumeIntegralInRange<int>(-1, most + 1);
        E result;
        std::memcpy(&result, &value, sizeof result); // as a C caller can
        return result;
    }
    /// Null, or good until the next one.
    const char *name() {
        text_ = ConsumeRandomLengthString(8);
        return ConsumeBool() ? text_.c_str() : nullptr;
    }
    /// Mostly a rigid or a scaled matrix, so that what follows has a chance.
    void matrix(double *rows) {
        for (size_t i = 0; i < 16; ++i)
            rows[i] = i % 5 == 0 ? 1 : 0;
        const int kind = ConsumeIntegralInRange<int>(0, 4);
        if (kind == 1)
            fill(rows, 16);
        for (size_t r = 0; kind >= 2 && r < 3; ++r)
            rows[4 * r + 3] = number();
        for (size_t r = 0; kind == 3 && r < 3; ++r)
            rows[5 * r] = number();
    }
    /// Seldom.
    template <class Desc>
    void spoil_size(Desc &desc) {
        if (ConsumeIntegralInRange<int>(0, 31) == 0)
            desc.struct_size = ConsumeBool() ? ConsumeIntegralInRange<size_t>(0, sizeof desc) : SIZE_MAX;
    }

  private:
    std::string text_;
};

} // namespace glimmer
