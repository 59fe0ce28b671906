// SPDX-License-Identifier: GPL-3.0-or-later
#include "npy.h"

#include "bytes.h"
#include "errors.h"
#include "text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace glimmer {
namespace {

/// The header's Python literal: {'descr': '<f4', 'fortran_order': False, 'shape': (3, 4), }
class HeaderParser {
  public:
    HeaderParser(std::string_view text, const std::string &name) : text_(text), name_(name) {}

    struct Header {
        std::string descr;
        bool fortran_order = false;
        std::vector<size_t> shape;
    };

    Header parse() {
        Header header;
        bool has_descr = false, has_order = false, has_shape = false;
        expect('{');
        while (!accept('}')) {
            const std::string key = quoted_text();
            expect(':');
            if (key == "descr") {
                if (peek() == '[')
                    throw InputError(name_ + ": a structured dtype is not allowed; plain numbers are");
                header.descr = quoted_text();
                has_descr = true;
            } else if (key == "fortran_order") {
                header.fortran_order = boolean();
                has_order = true;
            } else if (key == "shape") {
                header.shape = tuple();
                has_shape = true;
            } else {
                fail();
            }
            if (!accept(',') && peek() != '}')
                fail();
        }
        if (!has_descr || !has_order || !has_shape || peek() != 0)
            fail();
        return header;
    }

  private:
    [[noreturn]] void fail() const { throw InputError(name_ + ": the .npy header is damaged"); }
    char peek() {
        while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\n'))
            ++at_;
        return at_ < text_.size() ? text_[at_] : '\0';
    }
    bool accept(char character) {
        if (peek() != character)
            return false;
        ++at_;
        return true;
    }
    void expect(char character) {
        if (!accept(character))
            fail();
    }
    std::string quoted_text() {
        const char mark = peek();
        if (mark != '\'' && mark != '"')
            fail();
        const size_t end = text_.find(mark, at_ + 1);
        if (end == std::string_view::npos)
            fail();
        const std::string result(text_.substr(at_ + 1, end - at_ - 1));
        at_ = end + 1;
        return result;
    }
    bool boolean() {
        peek();
        for (const std::string_view word : {"True", "False"}) {
            if (text_.substr(at_, word.size()) == word) {
                at_ += word.size();
                return word == "True";
            }
        }
        fail();
    }
    std::vector<size_t> tuple() {
        std::vector<size_t> result;
        expect('(');
        while (!accept(')')) {
            peek();
            size_t value = 0;
            const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
            if (error != std::errc() || result.size() == 32)
                fail();
            at_ = static_cast<size_t>(end - text_.data());
            accept('L'); // Python 2
            result.push_back(value);
            if (!accept(',') && peek() != ')')
                fail();
        }
        return result;
    }

    std::string_view text_;
    const std::string &name_;
    size_t at_ = 0;
};

/// IEEE half to double.
double half_to_double(uint16_t bits) {
    const int exponent = bits >> 10 & 31;
    const double mantissa = bits & 1023;
    const double sign = bits & 0x8000 ? -1 : 1;
    if (exponent == 31)
        return mantissa != 0 ? std::numeric_limits<double>::quiet_NaN()
                             : sign * std::numeric_limits<double>::infinity();
    return exponent == 0 ? sign * std::ldexp(mantissa, -24) : sign * std::ldexp(mantissa + 1024, exponent - 25);
}

/// Calls store(position in C order, pointer to the element) for each element of a file in either order.
template <class F>
void for_each_element(const std::vector<size_t> &shape, bool fortran, size_t count, F &&store) {
    if (!fortran || shape.size() < 2) {
        for (size_t i = 0; i < count; ++i)
            store(i, i);
        return;
    }
    std::vector<size_t> stride(shape.size(), 1), index(shape.size(), 0);
    for (size_t d = shape.size() - 1; d-- > 0;)
        stride[d] = stride[d + 1] * shape[d + 1];
    size_t position = 0;
    for (size_t i = 0; i < count; ++i) {
        store(position, i);
        for (size_t d = 0; d < shape.size(); ++d) { // the first index runs fastest
            position += stride[d];
            if (++index[d] < shape[d])
                break;
            position -= stride[d] * shape[d];
            index[d] = 0;
        }
    }
}

template <class T, class U>
void convert(const NpyArray &array, std::string_view data, bool swap, bool fortran, std::vector<U> &out) {
    const size_t count = data.size() / sizeof(T);
    out.resize(count);
    for_each_element(array.shape, fortran, count, [&](size_t to, size_t from) {
        out[to] = static_cast<U>(load<T>(data.data() + from * sizeof(T), swap));
    });
}

} // namespace

std::string NpyArray::shape_text() const {
    std::string text = "(";
    for (size_t i = 0; i < shape.size(); ++i)
        text += (i ? ", " : "") + std::to_string(shape[i]);
    return text + (shape.size() == 1 ? ",)" : ")");
}

NpyArray parse_npy(std::string_view bytes, const std::string &name) {
    const auto fail = [&](const std::string &what) { throw InputError(name + ": " + what); };
    if (!bytes.starts_with("\x93NUMPY"))
        fail("is not a .npy file");
    if (bytes.size() < 10)
        fail("the .npy header is cut off");
    const int version = bytes[6];
    if (version < 1 || version > 3)
        fail(".npy format version " + std::to_string(version) + " is not known; 1 to 3 are");
    const size_t length_size = version == 1 ? 2 : 4;
    if (bytes.size() < 8 + length_size)
        fail("the .npy header is cut off");
    const size_t length =
        version == 1 ? load<uint16_t>(bytes.data() + 8, false) : load<uint32_t>(bytes.data() + 8, false);
    if (bytes.size() - 8 - length_size < length)
        fail("the .npy header is cut off");
    const auto header = HeaderParser(bytes.substr(8 + length_size, length), name).parse();

    NpyArray array{header.descr, header.shape, {}, {}};
    const std::string kind = header.descr.size() == 3 ? header.descr.substr(1) : "";
    constexpr std::string_view kinds[] = {"f2", "f4", "f8", "u1", "u2", "u4", "u8", "i1", "i2", "i4", "i8", "b1"};
    const bool known = std::find(std::begin(kinds), std::end(kinds), kind) != std::end(kinds) &&
                       std::string_view("<>|=").find(header.descr[0]) != std::string_view::npos;
    if (!known)
        fail("dtype " + in_quotes(header.descr) + " is not allowed; floats of 2, 4 or 8 bytes and integers are");
    const size_t item_size = static_cast<size_t>(kind[1] - '0');
    const bool swap = header.descr[0] == '>';

    const std::string_view data = bytes.substr(8 + length_size + length);
    size_t size = item_size;
    for (const size_t extent : header.shape)
        if (__builtin_mul_overflow(size, extent, &size))
            fail("the shape " + array.shape_text() + " is larger than any file");
    if (data.size() < size)
        fail("is cut off: shape " + array.shape_text() + " takes " + std::to_string(size) + " bytes, but " +
             std::to_string(data.size()) + " are there");
    if (data.size() > size)
        fail("has " + std::to_string(data.size() - size) + " bytes more than shape " + array.shape_text() + " takes");

    const bool fortran = header.fortran_order;
    if (kind == "f2") {
        std::vector<uint16_t> bits;
        convert<uint16_t>(array, data, swap, fortran, bits);
        for (const uint16_t value : bits)
            array.values.push_back(half_to_double(value));
    } else if (kind == "f4") {
        convert<float>(array, data, swap, fortran, array.values);
    } else if (kind == "f8") {
        convert<double>(array, data, swap, fortran, array.values);
    } else if (kind == "u1" || kind == "b1") {
        convert<uint8_t>(array, data, swap, fortran, array.integers);
    } else if (kind == "u2") {
        convert<uint16_t>(array, data, swap, fortran, array.integers);
    } else if (kind == "u4") {
        convert<uint32_t>(array, data, swap, fortran, array.integers);
    } else if (kind == "u8") {
        std::vector<uint64_t> wide;
        convert<uint64_t>(array, data, swap, fortran, wide);
        for (const uint64_t value : wide) // what int64 cannot hold is out of every range that anyone allows
            array.integers.push_back(static_cast<int64_t>(std::min(value, uint64_t(INT64_MAX))));
    } else if (kind == "i1") {
        convert<int8_t>(array, data, swap, fortran, array.integers);
    } else if (kind == "i2") {
        convert<int16_t>(array, data, swap, fortran, array.integers);
    } else if (kind == "i4") {
        convert<int32_t>(array, data, swap, fortran, array.integers);
    } else {
        convert<int64_t>(array, data, swap, fortran, array.integers);
    }
    return array;
}

} // namespace glimmer
