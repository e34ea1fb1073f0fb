// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/ini/ini_escape.hh"

#include <charconv>
#include <cstdint>

#include <fmt/format.h>

namespace mw::ini {
namespace {

constexpr std::string_view LETTERS = "abfnrtv\\\"'";
constexpr std::string_view MEANINGS = "\a\b\f\n\r\t\v\\\"'";
constexpr std::uint32_t FIRST_HIGH = 0xD800, FIRST_LOW = 0xDC00, END_OF_SURROGATES = 0xE000;
constexpr std::uint32_t END_OF_UNICODE = 0x110000;

bool isOctal(char c) {
    return c >= '0' && c <= '7';
}

bool isSurrogate(std::uint32_t code) {
    return code >= FIRST_HIGH && code < END_OF_SURROGATES;
}

void put_utf8(std::uint32_t code, std::string &out) {
    const auto tail = [&](int shift) { out += static_cast<char>(0x80U | ((code >> shift) & 0x3FU)); };
    if (code < 0x80) {
        out += static_cast<char>(code);
    } else if (code < 0x800) {
        out += static_cast<char>(0xC0U | (code >> 6));
        tail(0);
    } else if (code < 0x10000) {
        out += static_cast<char>(0xE0U | (code >> 12));
        tail(6);
        tail(0);
    } else {
        out += static_cast<char>(0xF0U | (code >> 18));
        tail(12);
        tail(6);
        tail(0);
    }
}

/// Length of the UTF-8 character at the start of `text`; 0 when it is not valid.
std::size_t utf8_length(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned first = byte(0);
    const std::size_t length = first < 0x80 ? 1 : first < 0xC2 ? 0 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
    if (length == 0 || first > 0xF4 || length > text.size()) {
        return 0;
    }
    std::uint32_t code = length == 1 ? first : first & (0x7FU >> length);
    for (std::size_t i = 1; i < length; ++i) {
        if ((byte(i) & 0xC0U) != 0x80) {
            return 0;
        }
        code = (code << 6) | (byte(i) & 0x3FU);
    }
    const bool overlong = (length == 3 && code < 0x800) || (length == 4 && code < 0x10000);
    return overlong || isSurrogate(code) || code >= END_OF_UNICODE ? 0 : length;
}

/// Decodes a value from start to end; stops at the first error.
class Decoder {
  public:
    explicit Decoder(std::string_view text) : rest_(text) {}

    Result<std::string> decode() {
        while (!rest_.empty() && fault_.empty()) {
            one();
        }
        if (!fault_.empty()) {
            return fail(fault_);
        }
        for (std::string_view left = out_; !left.empty();) {
            const std::size_t length = utf8_length(left);
            if (length == 0) {
                return fail("Value contains invalid UTF-8 sequence");
            }
            left.remove_prefix(length);
        }
        return out_;
    }

  private:
    void one() {
        const char c = rest_.front();
        const char next = c == '\\' && rest_.size() > 1 ? rest_[1] : '\0';
        if (c == '\0') {
            no_null("literal");
        } else if (next == '\0') {
            out_ += c;
            rest_.remove_prefix(1);
        } else if (isOctal(next)) {
            octal();
        } else if (next == 'x') {
            hex();
        } else if (next == 'u') {
            utf16();
        } else if (next == 'U') {
            utf32();
        } else {
            const auto at = LETTERS.find(next);
            out_ += at == LETTERS.npos ? std::string{c, next} : std::string(1, MEANINGS[at]);
            rest_.remove_prefix(2);
        }
    }

    void no_null(const char *kind) { fault_ = fmt::format("Embedded {} NUL character not supported", kind); }

    /// The digits after a backslash and a letter; `what` and `where` name them in messages.
    std::uint32_t digits(std::size_t count, const char *improper, const char *what, const char *where) {
        if (rest_.size() < 2 + count) {
            fault_ = fmt::format("Improper {} escape", improper);
            return 0;
        }
        const std::string_view text = rest_.substr(2, count);
        std::uint32_t code = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + count, code, 16);
        if (error != std::errc() || end != text.data() + count) {
            fault_ = fmt::format("Invalid {} '{}' in {} escape", what, text, where);
        }
        rest_.remove_prefix(2 + count);
        return code;
    }

    void octal() {
        std::uint32_t code = 0;
        std::size_t count = 1;
        for (; count <= 3 && count < rest_.size() && isOctal(rest_[count]); ++count) {
            code = code * 8 + static_cast<std::uint32_t>(rest_[count] - '0');
        }
        if (code == 0) {
            no_null("octal");
        } else if (code > 0xFF) {
            fault_ = fmt::format("Octal escape '{}' is above 377", rest_.substr(1, count - 1));
        }
        out_ += static_cast<char>(code);
        rest_.remove_prefix(count);
    }

    void hex() {
        const std::uint32_t code = digits(2, "hex", "hex", "hex");
        if (fault_.empty() && code == 0) {
            no_null("hex");
        }
        out_ += static_cast<char>(code);
    }

    void utf16() {
        std::uint32_t code = digits(4, "UTF-16", "hex value", "UTF-16");
        if (!fault_.empty()) {
            return;
        }
        if (code == 0) {
            no_null("UTF-16");
        } else if (code >= FIRST_LOW && code < END_OF_SURROGATES) {
            fault_ = fmt::format("Invalid high surrogate value u{:04X} in UTF-16", code);
        } else if (isSurrogate(code)) {
            code = with_low(code);
        }
        if (fault_.empty()) {
            put_utf8(code, out_);
        }
    }

    std::uint32_t with_low(std::uint32_t high) {
        if (!rest_.starts_with("\\u")) {
            fault_ = "Missing low surrogate in UTF-16";
            return 0;
        }
        const std::uint32_t low = digits(4, "UTF-16", "hex", "UTF-16 low surrogate");
        if (fault_.empty() && (low < FIRST_LOW || low >= END_OF_SURROGATES)) {
            fault_ = fmt::format("Invalid low surrogate value u{:04X} in UTF-16", low);
        }
        return 0x10000 + ((high - FIRST_HIGH) << 10) + (low - FIRST_LOW);
    }

    void utf32() {
        const std::uint32_t code = digits(8, "UTF-32", "hex value", "UTF-32");
        if (!fault_.empty()) {
            return;
        }
        if (code == 0) {
            no_null("UTF-32");
        } else if (code >= END_OF_UNICODE || isSurrogate(code)) {
            fault_ = fmt::format("Invalid code point U{:08X} in UTF-32 escape", code);
        } else {
            put_utf8(code, out_);
        }
    }

    std::string_view rest_;
    std::string out_;
    std::string fault_;
};

}  // namespace

Result<std::string> decode_ini_value(std::string_view text) {
    return Decoder(text).decode();
}

std::string encode_ini_value(std::string_view value) {
    constexpr std::string_view NAMED = "\a\b\f\n\r\t\v\\";
    std::string out;
    for (std::size_t i = 0; i < value.size(); ++i) {
        const char c = value[i];
        const auto at = NAMED.find(c);
        const bool is_end = i == 0 || i + 1 == value.size();
        // the backslash would continue the value on the next line
        const bool is_continuation = c == '\\' && i + 1 == value.size();
        if (at != NAMED.npos && !is_continuation) {
            out += {'\\', LETTERS[at]};
        } else if ((c == ' ' && is_end) || (c >= 0 && c < ' ') || c == '\x7f' || is_continuation) {
            out += fmt::format("\\x{:02x}", static_cast<unsigned>(c));
        } else {
            out += c;
        }
    }
    return out;
}

}  // namespace mw::ini
