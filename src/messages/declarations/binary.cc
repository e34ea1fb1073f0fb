// SPDX-License-Identifier: GPL-2.0-or-later
#include "messages/declarations/binary.hh"

#include <bit>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "messages/declarations/value.hh"

namespace mw::messages {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are copied as they are in memory");

template <class T>
void append(std::string &bytes, T value) {
    bytes.append(reinterpret_cast<const char *>(&value), sizeof value);
}

void encode_parts(const ConstObject &message, std::string &bytes);

void encode_element(const Field &field, const void *at, std::string &bytes) {
    const Type &type = field.type;
    switch (type.kind) {
    case Kind::BOOL:
    case Kind::INTEGER:
    case Kind::UNSIGNED:
    case Kind::NAMED: {
        const std::int64_t value = get_integer(type, at);
        bytes.append(reinterpret_cast<const char *>(&value), type.bytes);
        break;
    }
    case Kind::REAL: append(bytes, get_real(at)); break;
    case Kind::TEXT:
    case Kind::FIXED_TEXT: {
        const std::string_view text = get_text(type, at);
        append(bytes, static_cast<std::uint32_t>(text.size()));
        bytes += text;
        break;
    }
    case Kind::PARTS: encode_parts({type.parts, at}, bytes); break;
    }
}

void encode_parts(const ConstObject &message, std::string &bytes) {
    for (const Field &field : message.declaration->fields) {
        const void *at = field.at(const_cast<void *>(message.data));
        const std::size_t count = count_elements(field.type, at);
        if (field.type.list != nullptr) {
            append(bytes, static_cast<std::uint32_t>(count));
        }
        for (std::size_t i = 0; i < count; ++i) {
            encode_element(field, element(field.type, at, i), bytes);
        }
    }
}

/// Takes bytes from the front and detects the end of the data.
class Reader {
  public:
    explicit Reader(std::string_view bytes) : bytes_(bytes) {}
    std::size_t left() const { return bytes_.size(); }

    bool take(void *to, std::size_t size) {
        if (size > bytes_.size()) {
            return false;
        }
        std::memcpy(to, bytes_.data(), size);
        bytes_.remove_prefix(size);
        return true;
    }
    bool take_text(std::size_t size, std::string_view &text) {
        if (size > bytes_.size()) {
            return false;
        }
        text = bytes_.substr(0, size);
        bytes_.remove_prefix(size);
        return true;
    }

  private:
    std::string_view bytes_;
};

class Decoder {
  public:
    Decoder(const Declaration &declaration, std::string_view payload)
        : declaration_(declaration), reader_(payload) {}

    Result<> decode(const Object &message) {
        const auto status = parts(message);
        if (status.has_value() && reader_.left() > 0) {
            return fail(fmt::format("{}: {} bytes too many", declaration_.name, reader_.left()));
        }
        return status;
    }

  private:
    std::unexpected<Error> bad(const Field &field, const std::string &what) const {
        return fail(fmt::format("{}: {}: {}", declaration_.name, field.name, what));
    }

    Result<> parts(const Object &message) {
        for (const Field &field : message.declaration->fields) {
            void *at = field.at(message.data);
            if (field.type.list != nullptr) {
                const auto sized = list(field, at);
                if (!sized.has_value()) {
                    return sized;
                }
            }
            const std::size_t count = count_elements(field.type, at);
            for (std::size_t i = 0; i < count; ++i) {
                const auto status = one(field, element(field.type, at, i));
                if (!status.has_value()) {
                    return status;
                }
            }
        }
        return {};
    }

    Result<> list(const Field &field, void *at) {
        std::uint32_t count = 0;
        if (!reader_.take(&count, sizeof count)) {
            return bad(field, "the message ends within it");
        }
        if (!std::isfinite(field.range.max) || count > field.range.max) {
            return bad(field, fmt::format("{} entries are more than it may have", count));
        }
        if (count > reader_.left()) {  // each entry has at least one byte
            return bad(field, "the message ends within it");
        }
        field.type.list->resize(at, count);
        return {};
    }

    Result<> one(const Field &field, void *at) {
        const Type &type = field.type;
        switch (type.kind) {
        case Kind::BOOL:
        case Kind::INTEGER:
        case Kind::UNSIGNED:
        case Kind::NAMED: {
            std::uint64_t bits = 0;
            if (!reader_.take(&bits, type.bytes)) {
                return bad(field, "the message ends within it");
            }
            const bool is_number = type.kind == Kind::INTEGER || type.kind == Kind::UNSIGNED;
            if (!is_number && !isRepresentable(type, static_cast<std::int64_t>(bits))) {
                return bad(field, fmt::format("{} is not one of its values", bits));
            }
            set_integer(type, at, static_cast<std::int64_t>(bits));
            return {};
        }
        case Kind::REAL: {
            double value = 0;
            if (!reader_.take(&value, sizeof value)) {
                return bad(field, "the message ends within it");
            }
            set_real(at, value);
            return {};
        }
        case Kind::TEXT:
        case Kind::FIXED_TEXT: return text(field, at);
        case Kind::PARTS: return parts({type.parts, at});
        }
        return {};
    }

    Result<> text(const Field &field, void *at) {
        std::uint32_t size = 0;
        std::string_view text;
        if (!reader_.take(&size, sizeof size) || !reader_.take_text(size, text)) {
            return bad(field, "the message ends within it");
        }
        if (size > longest_text(field) || !set_text(field.type, at, text)) {
            return bad(field, fmt::format("{} bytes are longer than it may be", size));
        }
        return {};
    }

    const Declaration &declaration_;
    Reader reader_;
};

}  // namespace

void encode(const ConstObject &message, std::string &bytes) {
    const std::size_t start = bytes.size();
    bytes += "MW";
    bytes += static_cast<char>(BINARY_VERSION);
    bytes += '\0';
    append(bytes, static_cast<std::uint16_t>(message.declaration->number));
    append(bytes, std::uint32_t{0});
    encode_parts(message, bytes);
    const auto payload = static_cast<std::uint32_t>(bytes.size() - start - BINARY_HEAD);
    std::memcpy(bytes.data() + start + BINARY_HEAD - sizeof payload, &payload, sizeof payload);
}

Result<BinaryHead> read_head(std::string_view bytes) {
    Reader reader(bytes);
    char mark[4] = {};
    std::uint16_t number = 0;
    std::uint32_t payload = 0;
    if (!reader.take(mark, sizeof mark) || !reader.take(&number, sizeof number) ||
        !reader.take(&payload, sizeof payload)) {
        return fail(fmt::format("{} bytes are too few for a message", bytes.size()));
    }
    if (mark[0] != 'M' || mark[1] != 'W' || mark[3] != 0) {
        return fail("these bytes are no message of Millwright");
    }
    if (mark[2] != static_cast<char>(BINARY_VERSION)) {
        return fail(fmt::format("the message has version {}, this program has {}",
                                static_cast<int>(static_cast<unsigned char>(mark[2])), BINARY_VERSION));
    }
    return BinaryHead{number, payload};
}

Result<> decode(std::string_view bytes, const Object &message) {
    const auto head = read_head(bytes);
    if (!head.has_value()) {
        return std::unexpected(head.error());
    }
    if (head->number != message.declaration->number) {
        return fail(fmt::format("message {} came where {} ({}) was expected", head->number,
                                message.declaration->number, message.declaration->name));
    }
    if (head->payload != bytes.size() - BINARY_HEAD) {
        return fail(fmt::format("{}: says {} bytes, has {}", message.declaration->name, head->payload,
                                bytes.size() - BINARY_HEAD));
    }
    return Decoder(*message.declaration, bytes.substr(BINARY_HEAD)).decode(message);
}

}  // namespace mw::messages
