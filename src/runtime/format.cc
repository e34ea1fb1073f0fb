// SPDX-License-Identifier: GPL-2.0-or-later
#include "runtime/format.hh"

#include <charconv>
#include <cstdint>
#include <cstring>
#include <limits>

namespace mw::runtime {
namespace {

struct Output {
    char *buffer;
    std::size_t size;
    std::size_t length = 0;

    void put(char c) noexcept {
        if (length + 1 < size) {
            buffer[length] = c;
        }
        ++length;
    }
    void put(const char *text, std::size_t count) noexcept {
        for (std::size_t i = 0; i < count; ++i) {
            put(text[i]);
        }
    }
    void repeat(char c, int count) noexcept {
        for (int i = 0; i < count; ++i) {
            put(c);
        }
    }
};

struct Spec {
    bool left = false, has_plus = false, has_space = false, alternate = false, has_zeros = false;
    int width = 0;
    int precision = -1;
    int longs = 0;  ///< 0 int, 1 long, 2 long long and the like; -1 short, -2 char
    bool is_long_double = false;
};

/// va_list may be an array type; inside a struct it is passed by reference on all platforms.
struct Args {
    std::va_list list;
};

constexpr int WIDEST = 400;

int clamped(long value) noexcept {
    return value > WIDEST ? WIDEST : static_cast<int>(value);
}

int read_number(const char *&at) noexcept {
    long value = 0;
    while (*at >= '0' && *at <= '9') {
        value = value > WIDEST ? value : value * 10 + (*at - '0');
        ++at;
    }
    return clamped(value);
}

bool isFlag(char c, Spec &spec) noexcept {
    switch (c) {
    case '-': return spec.left = true;
    case '+': return spec.has_plus = true;
    case ' ': return spec.has_space = true;
    case '#': return spec.alternate = true;
    case '0': return spec.has_zeros = true;
    default: return false;
    }
}

Spec read_spec(const char *&at, Args &args) noexcept {
    Spec spec;
    while (isFlag(*at, spec)) {
        ++at;
    }
    if (*at == '*') {
        ++at;
        const int width = va_arg(args.list, int);
        spec.left = spec.left || width < 0;
        spec.width = clamped(width < 0 ? -static_cast<long>(width) : width);
    } else {
        spec.width = read_number(at);
    }
    if (*at == '.') {
        ++at;
        if (*at == '*') {
            ++at;
            const int precision = va_arg(args.list, int);
            spec.precision = precision < 0 ? -1 : clamped(precision);
        } else {
            spec.precision = read_number(at);
        }
    }
    for (;; ++at) {
        if (*at == 'l') {
            ++spec.longs;
        } else if (*at == 'h') {
            --spec.longs;
        } else if (*at == 'j' || *at == 'z' || *at == 't') {
            spec.longs = 2;
        } else if (*at == 'L') {
            spec.is_long_double = true;
        } else {
            return spec;
        }
    }
}

/// Writes prefix (sign, 0x) and body into the field.
void put_field(Output &out, const Spec &spec, const char *prefix, const char *body, std::size_t body_length,
               bool zeros_allowed) noexcept {
    const int prefix_length = static_cast<int>(std::strlen(prefix));
    const int padding = spec.width - prefix_length - static_cast<int>(body_length);
    const bool has_zeros = zeros_allowed && spec.has_zeros && !spec.left;
    if (!spec.left && !has_zeros) {
        out.repeat(' ', padding);
    }
    out.put(prefix, static_cast<std::size_t>(prefix_length));
    if (has_zeros) {
        out.repeat('0', padding);
    }
    out.put(body, body_length);
    if (spec.left) {
        out.repeat(' ', padding);
    }
}

const char *sign_of(const Spec &spec, bool negative) noexcept {
    return negative ? "-" : spec.has_plus ? "+" : spec.has_space ? " " : "";
}

void put_digits(Output &out, const Spec &spec, const char *prefix, std::uint64_t value, int base,
                bool upper) noexcept {
    constexpr int SIZE = WIDEST + 32;
    char digits[SIZE];
    int at = SIZE;
    while (value != 0) {
        const int digit = static_cast<int>(value % static_cast<unsigned>(base));
        digits[--at] = static_cast<char>(digit < 10 ? '0' + digit : (upper ? 'A' : 'a') + digit - 10);
        value /= static_cast<unsigned>(base);
    }
    const int wanted = spec.precision < 0 ? 1 : spec.precision;
    while (SIZE - at < wanted) {
        digits[--at] = '0';
    }
    put_field(out, spec, prefix, digits + at, static_cast<std::size_t>(SIZE - at), spec.precision < 0);
}

void put_signed(Output &out, const Spec &spec, Args &args) noexcept {
    std::int64_t value = spec.longs >= 2   ? va_arg(args.list, long long)
                         : spec.longs == 1 ? va_arg(args.list, long)
                                           : va_arg(args.list, int);
    value = spec.longs == -1   ? static_cast<short>(value)
            : spec.longs <= -2 ? static_cast<signed char>(value)
                               : value;
    const auto bits = static_cast<std::uint64_t>(value);
    put_digits(out, spec, sign_of(spec, value < 0), value < 0 ? 0 - bits : bits, 10, false);
}

void put_unsigned(Output &out, const Spec &spec, Args &args, char conversion) noexcept {
    std::uint64_t value = spec.longs >= 2   ? va_arg(args.list, unsigned long long)
                          : spec.longs == 1 ? va_arg(args.list, unsigned long)
                                            : va_arg(args.list, unsigned int);
    value = spec.longs == -1   ? static_cast<unsigned short>(value)
            : spec.longs <= -2 ? static_cast<unsigned char>(value)
                               : value;
    const bool is_hex = conversion == 'x' || conversion == 'X';
    const char *prefix = "";
    if (spec.alternate && value != 0) {
        prefix = conversion == 'x' ? "0x" : conversion == 'X' ? "0X" : conversion == 'o' ? "0" : "";
    }
    put_digits(out, spec, prefix, value, is_hex ? 16 : conversion == 'o' ? 8 : 10, conversion == 'X');
}

void put_double(Output &out, const Spec &spec, double value, char conversion) noexcept {
    char text[WIDEST];
    const bool negative = __builtin_signbit(value) != 0;
    const double magnitude = negative ? -value : value;
    const char lower = static_cast<char>(conversion | 0x20);
    const bool finite = __builtin_isfinite(value) != 0;
    std::to_chars_result result{};
    if (!finite) {
        std::memcpy(text, __builtin_isnan(value) != 0 ? "nan" : "inf", 3);
        result.ptr = text + 3;
    } else if (lower == 'a' && spec.precision < 0) {
        result = std::to_chars(text, text + WIDEST, magnitude, std::chars_format::hex);
    } else {
        const auto style = lower == 'f'   ? std::chars_format::fixed
                           : lower == 'e' ? std::chars_format::scientific
                           : lower == 'a' ? std::chars_format::hex
                                          : std::chars_format::general;
        result =
            std::to_chars(text, text + WIDEST, magnitude, style, spec.precision < 0 ? 6 : spec.precision);
    }
    std::size_t length = result.ec == std::errc() ? static_cast<std::size_t>(result.ptr - text) : 0;
    if (length == 0) {
        text[length++] = '?';
    }
    if (conversion != lower) {
        for (std::size_t i = 0; i < length; ++i) {
            text[i] = text[i] >= 'a' && text[i] <= 'z' ? static_cast<char>(text[i] - 32) : text[i];
        }
    }
    if (lower == 'a' && finite) {
        const char *prefix = negative ? "-0x" : spec.has_plus ? "+0x" : "0x";
        put_field(out, spec, prefix, text, length, true);
        return;
    }
    put_field(out, spec, sign_of(spec, negative), text, length, finite);
}

void put_string(Output &out, const Spec &spec, const char *text) noexcept {
    if (text == nullptr) {
        text = "(null)";
    }
    const std::size_t limit = spec.precision < 0 ? std::numeric_limits<std::size_t>::max()
                                                 : static_cast<std::size_t>(spec.precision);
    std::size_t length = 0;
    while (length < limit && text[length] != '\0') {
        ++length;
    }
    put_field(out, spec, "", text, length, false);
}

/// Writes one conversion; false, and no output, if it is not supported.
bool isConverted(Output &out, Spec &spec, Args &args, char conversion) noexcept {
    switch (conversion) {
    case 'd':
    case 'i': put_signed(out, spec, args); return true;
    case 'u':
    case 'o':
    case 'x':
    case 'X': put_unsigned(out, spec, args, conversion); return true;
    case 'c': {
        const char c = static_cast<char>(va_arg(args.list, int));
        put_field(out, spec, "", &c, 1, false);
        return true;
    }
    case 's': put_string(out, spec, va_arg(args.list, const char *)); return true;
    case 'p':
        spec.precision = -1;
        put_digits(out, spec, "0x", reinterpret_cast<std::uintptr_t>(va_arg(args.list, void *)), 16, false);
        return true;
    case 'f':
    case 'F':
    case 'e':
    case 'E':
    case 'g':
    case 'G':
    case 'a':
    case 'A':
        put_double(out, spec,
                   spec.is_long_double ? static_cast<double>(va_arg(args.list, long double))
                                       : va_arg(args.list, double),
                   conversion);
        return true;
    default: return false;
    }
}

}  // namespace

int format_text(char *buffer, std::size_t size, const char *format, std::va_list list) noexcept {
    Output out{buffer, size};
    Args args;
    va_copy(args.list, list);
    for (const char *at = format; *at != '\0'; ++at) {
        if (*at != '%') {
            out.put(*at);
            continue;
        }
        const char *start = at++;
        if (*at == '%') {
            out.put('%');
            continue;
        }
        Spec spec = read_spec(at, args);
        if (!isConverted(out, spec, args, *at)) {
            out.put(start, static_cast<std::size_t>(at - start));
            if (*at == '\0') {
                break;
            }
            out.put(*at);
        }
    }
    va_end(args.list);
    if (size > 0) {
        buffer[out.length < size ? out.length : size - 1] = '\0';
    }
    return static_cast<int>(out.length);
}

}  // namespace mw::runtime
