// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/screen/status/status_delta.hh"

#include <cstring>
#include <utility>

#include "messages/declarations/json.hh"
#include "messages/declarations/value.hh"

namespace mw::screen {
namespace {

using messages::Field;
using messages::Kind;

/// Compares two statuses by their declarations.
class Comparison {
  public:
    Comparison(const messages::MachineStatus &now, PartMask parts)
        : begin_(reinterpret_cast<const char *>(&now)), parts_(parts) {}

    /// Appends {...} with the differences; false, and no text, if there are none.
    bool fields(const messages::Declaration &declaration, const void *now, const void *told) {
        const std::size_t before = text.size();
        for (const Field &field : declaration.fields) {
            const void *now_at = field.at(const_cast<void *>(now));
            const void *told_at = field.at(const_cast<void *>(told));
            if (!isFresh(field.type, now_at)) {
                continue;
            }
            const std::size_t undo = begin(before, field.name);
            const bool differs = messages::isSeries(field.type) ? series(field, now_at, told_at)
                                                                : value(field, now_at, told_at);
            text.resize(differs ? text.size() : undo);
        }
        return end(before);
    }

    std::string text;

  private:
    bool series(const Field &field, const void *now, const void *told) {
        const std::size_t before = text.size();
        const std::size_t count = messages::count_elements(field.type, now);
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t undo = begin(before, std::to_string(i));
            const bool differs =
                value(field, messages::element(field.type, now, i), messages::element(field.type, told, i));
            text.resize(differs ? text.size() : undo);
        }
        return end(before);
    }

    bool value(const Field &field, const void *now, const void *told) {
        const messages::Type &type = field.type;
        if (type.kind == Kind::PARTS) {
            return fields(*type.parts, now, told);
        }
        const bool is_text = type.kind == Kind::TEXT || type.kind == Kind::FIXED_TEXT;
        const bool same = is_text ? messages::get_text(type, now) == messages::get_text(type, told)
                                  : std::memcmp(now, told, type.bytes) == 0;
        if (!same) {
            text += messages::to_json(field, now);
        }
        return !same;
    }

    /// True if any of its bytes is in a part that is compared.
    bool isFresh(const messages::Type &type, const void *at) const {
        const auto &starts = messages::status_part::STARTS;
        const auto low = static_cast<std::size_t>(static_cast<const char *>(at) - begin_);
        const std::size_t high = low + std::size_t{type.stride} * type.count;
        for (std::size_t i = 0; i < starts.size() && starts[i] < high; ++i) {
            const bool reaches = i + 1 == starts.size() || starts[i + 1] > low;
            if (reaches && (parts_ >> i & 1U) != 0) {
                return true;
            }
        }
        return false;
    }

    /// @return the length to which the text is cut if there is no change
    std::size_t begin(std::size_t object, std::string_view name) {
        const std::size_t undo = text.size();
        text += text.size() == object ? "{\"" : ",\"";
        text += name;
        text += "\":";
        return undo;
    }
    bool end(std::size_t object) {
        if (text.size() == object) {
            return false;
        }
        text += '}';
        return true;
    }

    const char *begin_;
    PartMask parts_;
};

}  // namespace

std::string StatusDelta::whole(const messages::MachineStatus &now) {
    *told_ = now;
    return messages::to_json(messages::object(now));
}

std::string StatusDelta::next(const messages::MachineStatus &now, PartMask parts) {
    Comparison comparison(now, parts);
    comparison.fields(messages::DECLARATION<messages::MachineStatus>, &now, told_.get());
    *told_ = now;
    return std::move(comparison.text);
}

}  // namespace mw::screen
