// SPDX-License-Identifier: GPL-2.0-or-later
#include <cmath>

#include <fmt/format.h>

#include "clients/nml/message/format.hh"
#include "messages/declarations/value.hh"

namespace mw::nml {
namespace {

using messages::Field;
using messages::Kind;

class Update {
  public:
    Update(Format &format, const messages::Declaration &declaration)
        : format_(format), declaration_(declaration) {}

    Result<> parts(const messages::Object &message) {
        for (const Field &field : message.declaration->fields) {
            void *at = field.at(message.data);
            if (field.type.list != nullptr) {
                const auto status = list(field, at);
                if (!status.has_value()) {
                    return status;
                }
            }
            const std::size_t count = messages::count_elements(field.type, at);
            for (std::size_t i = 0; i < count; ++i) {
                const auto status = one({field, i}, messages::element(field.type, at, i));
                if (!status.has_value()) {
                    return status;
                }
            }
        }
        return {};
    }

  private:
    std::unexpected<Error> bad(const Field &field, const std::string &what) const {
        return fail(fmt::format("{}: {}: {}", declaration_.name, field.name, what));
    }
    Result<> told(const Field &field, bool is_good) const {
        return is_good ? Result<>{} : bad(field, format_.problem());
    }

    Result<> list(const Field &field, void *at) {
        auto count = static_cast<std::uint32_t>(field.type.list->size(at));
        if (!format_.count({field, 0}, count)) {
            return bad(field, format_.problem());
        }
        if (!std::isfinite(field.range.max) || count > field.range.max) {
            return bad(field, fmt::format("{} entries are more than it may have", count));
        }
        if (format_.isReading()) {
            field.type.list->resize(at, count);
        }
        return {};
    }

    Result<> one(const Value &value, void *at) {
        const messages::Type &type = value.field.type;
        switch (type.kind) {
        case Kind::BOOL:
        case Kind::INTEGER:
        case Kind::UNSIGNED:
        case Kind::NAMED: return integer(value, at);
        case Kind::REAL: {
            double number = messages::get_real(at);
            const bool is_good = format_.real(value, number);
            if (is_good && format_.isReading()) {
                messages::set_real(at, number);
            }
            return told(value.field, is_good);
        }
        case Kind::TEXT:
        case Kind::FIXED_TEXT: return text(value, at);
        case Kind::PARTS: {
            format_.enter(value);
            const auto status = parts({type.parts, at});
            format_.leave();
            return status;
        }
        }
        return {};
    }

    Result<> integer(const Value &value, void *at) {
        const messages::Type &type = value.field.type;
        std::int64_t number = messages::get_integer(type, at);
        if (!format_.integer(value, number)) {
            return bad(value.field, format_.problem());
        }
        if (format_.isReading()) {
            if (!messages::isRepresentable(type, number)) {
                return bad(value.field, fmt::format("{} is not one of its values", number));
            }
            messages::set_integer(type, at, number);
        }
        return {};
    }

    Result<> text(const Value &value, void *at) {
        const messages::Type &type = value.field.type;
        const std::size_t longest = messages::longest_text(value.field);
        std::string_view text = messages::get_text(type, at);
        if (text.size() > longest) {
            return bad(value.field, fmt::format("{} bytes are longer than it may be", text.size()));
        }
        if (!format_.text(value, text, longest)) {
            return bad(value.field, format_.problem());
        }
        if (format_.isReading() && !messages::set_text(type, at, text)) {
            return bad(value.field, fmt::format("{} bytes are longer than it may be", text.size()));
        }
        return {};
    }

    Format &format_;
    const messages::Declaration &declaration_;
};

class Shape {
  public:
    void mix(const messages::Declaration &declaration) {
        mix(static_cast<std::uint64_t>(declaration.fields.size()));
        for (const Field &field : declaration.fields) {
            for (const char *c = field.name; *c != '\0'; ++c) {
                mix(static_cast<unsigned char>(*c));
            }
            mix(static_cast<std::uint64_t>(field.type.kind));
            mix(field.type.bytes);
            mix(field.type.list != nullptr ? 0 : field.type.count);
            if (field.type.parts != nullptr) {
                mix(*field.type.parts);
            }
        }
    }
    std::uint32_t value() const { return static_cast<std::uint32_t>(hash_ ^ (hash_ >> 32U)); }

  private:
    void mix(std::uint64_t value) {
        constexpr std::uint64_t FNV_PRIME = 1099511628211ULL;
        for (unsigned i = 0; i < 8; ++i) {
            hash_ = (hash_ ^ ((value >> (8 * i)) & 0xffU)) * FNV_PRIME;
        }
    }
    std::uint64_t hash_ = 14695981039346656037ULL;
};

}  // namespace

Result<> update(Format &format, const messages::Object &message) {
    return Update(format, *message.declaration).parts(message);
}

std::uint32_t shape_of(const messages::Declaration &head, const messages::Declaration &body) {
    Shape shape;
    shape.mix(head);
    shape.mix(body);
    return shape.value();
}

}  // namespace mw::nml
