// SPDX-License-Identifier: GPL-3.0-or-later
#include "bytes.h"
#include "errors.h"
#include "mesh_data.h"
#include "ply_header.h"
#include "text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <utility>

namespace glimmer {
namespace {

/// Hands out the numbers after the header one by one, as float64, which holds every type of the format exactly.
class PlyNumbers {
  public:
    PlyNumbers(std::string_view data, PlyHeader::Format format, const std::string &name)
        : data_(data), format_(format), name_(name) {}

    double next(PlyType type) {
        if (format_ == PlyHeader::Ascii)
            return next_word();
        const size_t size = ply_size(type);
        if (data_.size() - at_ < size)
            cut_off();
        const char *bytes = data_.data() + at_;
        const bool swap = format_ == PlyHeader::BigEndian;
        at_ += size;
        switch (type) {
        case PlyType::Int8:
            return load<int8_t>(bytes, swap);
        case PlyType::Uint8:
            return load<uint8_t>(bytes, swap);
        case PlyType::Int16:
            return load<int16_t>(bytes, swap);
        case PlyType::Uint16:
            return load<uint16_t>(bytes, swap);
        case PlyType::Int32:
            return load<int32_t>(bytes, swap);
        case PlyType::Uint32:
            return load<uint32_t>(bytes, swap);
        case PlyType::Float32:
            return load<float>(bytes, swap);
        default:
            return load<double>(bytes, swap);
        }
    }

    /// Refuses a count of elements that the rest of the file cannot hold, before anyone allocates for it.
    void expect_room(const PlyElement &element) const {
        size_t least = 0; // bytes of an element; in text one digit and one space a number
        for (const PlyProperty &property : element.properties)
            least += format_ == PlyHeader::Ascii ? 2 : ply_size(property.is_list ? property.count_type : property.type);
        const size_t rest = data_.size() - at_ + (format_ == PlyHeader::Ascii ? 1 : 0);
        if (least != 0 && element.count > rest / least)
            throw InputError(name_ + ": is cut off: " + std::to_string(element.count) + " of element " +
                             in_quotes(element.name) + " cannot be in the " + std::to_string(data_.size() - at_) +
                             " bytes that follow");
    }

  private:
    [[noreturn]] void cut_off() const { throw InputError(name_ + ": is cut off"); }

    double next_word() {
        constexpr std::string_view space = " \t\r\n\f\v";
        at_ = std::min(data_.find_first_not_of(space, at_), data_.size());
        if (at_ == data_.size())
            cut_off();
        const size_t end = std::min(data_.find_first_of(space, at_), data_.size());
        const std::string_view word = data_.substr(at_, end - at_);
        at_ = end;
        const std::string_view digits = word.starts_with('+') ? word.substr(1) : word;
        double value = 0;
        const auto [last, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
        // Out of range is an overflow, found as not finite later, or an underflow, which is 0.
        if (error == std::errc::result_out_of_range)
            return digits.find("e-") != std::string_view::npos || digits.find("E-") != std::string_view::npos
                       ? 0
                       : std::numeric_limits<double>::infinity();
        if (error != std::errc() || last != digits.data() + digits.size())
            throw InputError(name_ + ": " + in_quotes(word) + " is not a number");
        return value;
    }

    std::string_view data_;
    PlyHeader::Format format_;
    const std::string &name_;
    size_t at_ = 0;
};

/// Where a vertex property goes: x y z 0 to 2, nx ny nz 3 to 5, s t 6 and 7; -1 nowhere.
int vertex_column(std::string_view name) {
    constexpr std::pair<std::string_view, int> table[] = {{"x", 0},  {"y", 1},  {"z", 2},         {"nx", 3},
                                                          {"ny", 4}, {"nz", 5}, {"s", 6},         {"t", 7},
                                                          {"u", 6},  {"v", 7},  {"texture_u", 6}, {"texture_v", 7}};
    for (const auto &[known, column] : table)
        if (name == known)
            return column;
    return -1;
}

class PlyReader {
  public:
    PlyReader(std::string_view data, PlyHeader::Format format, const std::string &name)
        : name_(name), numbers_(data, format, name) {}

    void read(const PlyElement &element) {
        numbers_.expect_room(element);
        if (element.name == "vertex")
            read_vertices(element);
        else if (element.name == "face")
            read_faces(element);
        else if (element.name == "tristrips")
            fail("element \"tristrips\" is not supported; element \"face\" is");
        else if (!element.properties.empty())
            for (uint64_t i = 0; i < element.count; ++i)
                for (const PlyProperty &property : element.properties)
                    skip(property);
    }

    MeshData finish() {
        if (!has_vertices_ || !has_faces_)
            fail(std::string("has no element \"") + (has_vertices_ ? "face" : "vertex") + "\"");
        for (size_t i = 0; i < mesh_.triangles.size(); ++i)
            if (mesh_.triangles[i] >= mesh_.vertex_count())
                fail("triangle " + std::to_string(i / 3) + " uses vertex " + std::to_string(mesh_.triangles[i]) +
                     "; there are " + std::to_string(mesh_.vertex_count()));
        return std::move(mesh_);
    }

  private:
    [[noreturn]] void fail(const std::string &what) const { throw InputError(name_ + ": " + what); }

    uint64_t list_size(const PlyProperty &property) {
        const double count = numbers_.next(property.count_type);
        if (!(count >= 0 && count <= 4294967295.0) || count != double(uint64_t(count)))
            fail("a list has the length " + number_text(count));
        return static_cast<uint64_t>(count);
    }
    void skip(const PlyProperty &property) {
        for (uint64_t left = property.is_list ? list_size(property) : 1; left > 0; --left)
            numbers_.next(property.type); // a wrong length ends at the end of the file
    }

    void read_vertices(const PlyElement &element) {
        if (std::exchange(has_vertices_, true))
            fail("has element \"vertex\" twice");
        std::vector<int> columns;
        std::array<int, 8> found{};
        for (const PlyProperty &property : element.properties) {
            columns.push_back(property.is_list ? -1 : vertex_column(property.name));
            if (columns.back() >= 0 && ++found[size_t(columns.back())] > 1)
                fail("element \"vertex\" has two properties for the place of " + in_quotes(property.name));
        }
        const auto has = [&](size_t begin, size_t end, const char *what) {
            const auto count = std::count(found.begin() + ptrdiff_t(begin), found.begin() + ptrdiff_t(end), 1);
            if (count != 0 && size_t(count) != end - begin)
                fail(std::string("element \"vertex\" has only a part of ") + what);
            return count != 0;
        };
        if (!has(0, 3, "x, y, z"))
            fail("element \"vertex\" has no x, y, z");
        const bool has_normals = has(3, 6, "nx, ny, nz"), has_uvs = has(6, 8, "s, t (or u, v)");
        const auto count = static_cast<size_t>(element.count);
        mesh_.vertices.resize(3 * count);
        mesh_.normals.resize(has_normals ? 3 * count : 0);
        mesh_.uvs.resize(has_uvs ? 2 * count : 0);
        for (size_t i = 0; i < count; ++i) {
            for (size_t p = 0; p < columns.size(); ++p) {
                const int column = columns[p];
                if (column < 0)
                    skip(element.properties[p]);
                else if (const double value = numbers_.next(element.properties[p].type); column < 3)
                    mesh_.vertices[3 * i + size_t(column)] = value;
                else if (column < 6)
                    mesh_.normals[3 * i + size_t(column) - 3] = value;
                else
                    mesh_.uvs[2 * i + size_t(column) - 6] = value;
            }
        }
    }

    void read_faces(const PlyElement &element) {
        if (std::exchange(has_faces_, true))
            fail("has element \"face\" twice");
        const auto is_indices = [](const PlyProperty &property) {
            return property.is_list && (property.name == "vertex_indices" || property.name == "vertex_index");
        };
        if (std::count_if(element.properties.begin(), element.properties.end(), is_indices) != 1)
            fail("element \"face\" does not have one list vertex_indices");
        for (uint64_t i = 0; i < element.count; ++i)
            for (const PlyProperty &property : element.properties)
                if (is_indices(property))
                    read_polygon(property, i);
                else
                    skip(property);
    }

    void read_polygon(const PlyProperty &property, uint64_t face) {
        const uint64_t size = list_size(property);
        if (size < 3)
            fail("face " + std::to_string(face) + " has " + count_text(size, "vertex", "vertices") +
                 "; 3 or more are allowed");
        const auto next_index = [&] {
            const double index = numbers_.next(property.type);
            if (!(index >= 0 && index <= 4294967295.0) || index != double(uint32_t(index)))
                fail("face " + std::to_string(face) + " has the vertex " + number_text(index) +
                     "; vertices count from 0");
            return static_cast<uint32_t>(index);
        };
        const uint32_t first = next_index();
        uint32_t previous = next_index();
        for (uint64_t corner = 2; corner < size; ++corner) {
            const uint32_t current = next_index();
            mesh_.triangles.insert(mesh_.triangles.end(), {first, previous, current});
            previous = current;
        }
    }

    const std::string &name_;
    PlyNumbers numbers_;
    MeshData mesh_;
    bool has_vertices_ = false, has_faces_ = false;
};

} // namespace

MeshData parse_ply(std::string_view bytes, const std::string &name) {
    const PlyHeader header = parse_ply_header(bytes, name);
    PlyReader reader(bytes.substr(header.size), header.format, name);
    for (const PlyElement &element : header.elements)
        reader.read(element);
    return reader.finish();
}

} // namespace glimmer
