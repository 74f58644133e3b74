// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include <springfit/io/detail/read_text.hpp>
#include <springfit/io/detail/text_scanner.hpp>

namespace springfit::io::detail {

/// How a number is stored in the binary part of a file.
enum class NumberType { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

/// The type of a name that PLY or VTK files use, in any case; none where it is not known.
[[nodiscard]] inline std::optional<NumberType> number_type(std::string_view name) {
    struct Name {
        std::string_view name;
        NumberType type;
    };
    constexpr std::array<Name, 22> names{{
        {"char", NumberType::int8},           {"int8", NumberType::int8},
        {"uchar", NumberType::uint8},         {"uint8", NumberType::uint8},
        {"unsigned_char", NumberType::uint8}, {"short", NumberType::int16},
        {"int16", NumberType::int16},         {"ushort", NumberType::uint16},
        {"uint16", NumberType::uint16},       {"unsigned_short", NumberType::uint16},
        {"int", NumberType::int32},           {"int32", NumberType::int32},
        {"uint", NumberType::uint32},         {"uint32", NumberType::uint32},
        {"unsigned_int", NumberType::uint32}, {"vtktypeint64", NumberType::int64},
        {"long", NumberType::int64},          {"unsigned_long", NumberType::uint64},
        {"float", NumberType::float32},       {"float32", NumberType::float32},
        {"double", NumberType::float64},      {"float64", NumberType::float64},
    }};
    const std::string lower = lower_case(name);
    const auto found = std::find_if(names.begin(), names.end(), [&](const Name& n) { return n.name == lower; });
    return found == names.end() ? std::nullopt : std::optional(found->type);
}

/// The next number of a binary part. (Whole numbers beyond 2^53 are rounded: no file has so many of anything.)
[[nodiscard]] inline double binary_number(TextScanner& scanner, NumberType type, std::endian order) {
    switch (type) {
    case NumberType::int8: return scanner.bytes<std::int8_t>(order);
    case NumberType::uint8: return scanner.bytes<std::uint8_t>(order);
    case NumberType::int16: return scanner.bytes<std::int16_t>(order);
    case NumberType::uint16: return scanner.bytes<std::uint16_t>(order);
    case NumberType::int32: return scanner.bytes<std::int32_t>(order);
    case NumberType::uint32: return scanner.bytes<std::uint32_t>(order);
    case NumberType::int64: return static_cast<double>(scanner.bytes<std::int64_t>(order));
    case NumberType::uint64: return static_cast<double>(scanner.bytes<std::uint64_t>(order));
    case NumberType::float32: return static_cast<double>(scanner.bytes<float>(order));
    case NumberType::float64: break;
    }
    return scanner.bytes<double>(order);
}

/// The next number of a binary part that counts or names something.
[[nodiscard]] inline long long binary_whole(TextScanner& scanner, NumberType type, std::endian order,
                                            std::string_view expected) {
    const double value = binary_number(scanner, type, order);
    if (!(value == std::floor(value) && std::abs(value) <= 9007199254740992.)) { // 2^53
        scanner.refuse(text("expected ", expected, ", found ", value));
    }
    return static_cast<long long>(value);
}

} // namespace springfit::io::detail
