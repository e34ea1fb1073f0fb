// SPDX-License-Identifier: GPL-2.0-or-later
#include "messages/declarations/json.hh"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include <fmt/format.h>

#include "messages/declarations/json_parse.hh"
#include "messages/declarations/value.hh"

namespace mw::messages {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char *NAME_KEY = "message";

Json parts_to_json(const ConstObject &message);

Json real_to_json(double value) {
    if (std::isfinite(value)) {
        return value;
    }
    return std::isnan(value) ? "nan" : value > 0 ? "inf" : "-inf";
}

Json element_to_json(const Field &field, const void *at) {
    const Type &type = field.type;
    switch (type.kind) {
    case Kind::BOOL: return get_integer(type, at) != 0;
    case Kind::INTEGER: return get_integer(type, at);
    case Kind::UNSIGNED: return static_cast<std::uint64_t>(get_integer(type, at));
    case Kind::REAL: return real_to_json(get_real(at));
    case Kind::NAMED: {
        const std::int64_t value = get_integer(type, at);
        const char *name = name_of(type, value);
        return name == nullptr ? Json(value) : Json(name);
    }
    case Kind::TEXT:
    case Kind::FIXED_TEXT: return std::string(get_text(type, at));
    case Kind::PARTS: return parts_to_json({type.parts, at});
    }
    return {};
}

Json parts_to_json(const ConstObject &message) {
    Json json = Json::object();
    for (const Field &field : message.declaration->fields) {
        const void *at = field.at(const_cast<void *>(message.data));
        if (!isSeries(field.type)) {
            json[field.name] = element_to_json(field, at);
            continue;
        }
        Json &series = json[field.name] = Json::array();
        const std::size_t count = count_elements(field.type, at);
        for (std::size_t i = 0; i < count; ++i) {
            series.push_back(element_to_json(field, element(field.type, at, i)));
        }
    }
    return json;
}

std::string text_of(const Json &json) {
    constexpr int COMPACT = -1;
    constexpr bool IS_ASCII = false;
    return json.dump(COMPACT, ' ', IS_ASCII, Json::error_handler_t::replace);
}

class Reading {
  public:
    explicit Reading(const Declaration &declaration) : declaration_(declaration) {}

    Result<> parts(const Json &json, const Object &object, bool is_whole) {
        for (const auto &[key, value] : json.items()) {
            const auto &fields = object.declaration->fields;
            const bool known = (is_whole && key == NAME_KEY) ||
                               std::any_of(fields.begin(), fields.end(),
                                           [&name = key](const Field &field) { return name == field.name; });
            if (!known) {
                return fail(fmt::format("{}: there is no field '{}'", declaration_.name, key));
            }
        }
        for (const Field &field : object.declaration->fields) {
            const auto found = json.find(field.name);
            if (found == json.end()) {
                if (field.presence == Presence::REQUIRED) {
                    return bad(field, "is missing");
                }
                continue;
            }
            const auto status = whole(field, *found, field.at(object.data));
            if (!status.has_value()) {
                return status;
            }
        }
        return {};
    }

  private:
    std::unexpected<Error> bad(const Field &field, const std::string &what) const {
        return fail(fmt::format("{}: {} {}", declaration_.name, field.name, what));
    }

    Result<> whole(const Field &field, const Json &json, void *at) {
        if (!isSeries(field.type)) {
            return one(field, json, at);
        }
        if (!json.is_array()) {
            return bad(field, "must be an array");
        }
        if (field.type.list != nullptr) {
            if (static_cast<double>(json.size()) > field.range.max) {
                return bad(field, "has too many entries");
            }
            field.type.list->resize(at, json.size());
        } else if (json.size() != field.type.count) {
            return bad(field, fmt::format("must have {} entries", field.type.count));
        }
        for (std::size_t i = 0; i < json.size(); ++i) {
            const auto status = one(field, json[i], element(field.type, at, i));
            if (!status.has_value()) {
                return status;
            }
        }
        return {};
    }

    Result<> one(const Field &field, const Json &json, void *at) {
        switch (field.type.kind) {
        case Kind::BOOL:
            if (!json.is_boolean()) {
                return bad(field, "must be true or false");
            }
            set_integer(field.type, at, json.get<bool>() ? 1 : 0);
            return {};
        case Kind::INTEGER:
        case Kind::UNSIGNED: return integer(field, json, at);
        case Kind::REAL: return real(field, json, at);
        case Kind::NAMED: return named_value(field, json, at);
        case Kind::TEXT:
        case Kind::FIXED_TEXT: {
            if (!json.is_string()) {
                return bad(field, "must be a text");
            }
            const auto &text = json.get_ref<const std::string &>();
            return text.size() <= longest_text(field) && set_text(field.type, at, text)
                       ? Result<>{}
                       : bad(field, fmt::format("is longer than {} bytes", longest_text(field)));
        }
        case Kind::PARTS:
            return json.is_object() ? parts(json, {field.type.parts, at}, false)
                                    : bad(field, "must be an object");
        }
        return {};
    }

    Result<> integer(const Field &field, const Json &json, void *at) {
        const bool is_unsigned = json.is_number_unsigned();
        if (!is_unsigned && !json.is_number_integer()) {
            return bad(field, "must be a whole number");
        }
        constexpr auto MOST = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
        const bool large = is_unsigned && json.get<std::uint64_t>() > MOST;
        const bool wide = field.type.kind == Kind::UNSIGNED && field.type.bytes == 8;
        const auto value = static_cast<std::int64_t>(
            is_unsigned ? json.get<std::uint64_t>() : static_cast<std::uint64_t>(json.get<std::int64_t>()));
        const bool fitting = wide ? (large || value >= 0) : !large && isRepresentable(field.type, value);
        if (!fitting) {
            return bad(field, "is " + json.dump() + ", which is out of its range");
        }
        set_integer(field.type, at, value);
        return {};
    }

    Result<> real(const Field &field, const Json &json, void *at) {
        if (json.is_number()) {
            set_real(at, json.get<double>());
            return {};
        }
        const std::string text = json.is_string() ? json.get<std::string>() : "";
        constexpr double INFINITE = std::numeric_limits<double>::infinity();
        if (text == "inf" || text == "-inf") {
            set_real(at, text == "inf" ? INFINITE : -INFINITE);
        } else if (text == "nan") {
            set_real(at, std::numeric_limits<double>::quiet_NaN());
        } else {
            return bad(field, "must be a number");
        }
        return {};
    }

    Result<> named_value(const Field &field, const Json &json, void *at) {
        const std::string text = json.is_string() ? json.get<std::string>() : "";
        std::string names;
        for (const Name &name : field.type.names) {
            if (text == name.name) {
                set_integer(field.type, at, name.value);
                return {};
            }
            names += (names.empty() ? "" : ", ") + std::string(name.name);
        }
        return bad(field, "must be one of " + names);
    }

    const Declaration &declaration_;
};

}  // namespace

std::string to_json(const ConstObject &message) {
    Json json{{NAME_KEY, message.declaration->name}};
    json.update(parts_to_json(message));
    return text_of(json);
}

std::string to_json(const Field &field, const void *at) {
    return text_of(element_to_json(field, at));
}

Result<std::string> json_name(std::string_view text) {
    const Json json = parse_json(text);
    if (!json.is_object()) {
        return fail("this is no JSON object");
    }
    const auto name = json.find(NAME_KEY);
    if (name == json.end() || !name->is_string()) {
        return fail(fmt::format("the JSON object has no text '{}'", NAME_KEY));
    }
    return name->get<std::string>();
}

Result<> from_json(std::string_view text, const Object &message) {
    const auto name = json_name(text);
    if (!name.has_value()) {
        return std::unexpected(name.error());
    }
    if (*name != message.declaration->name) {
        return fail(
            fmt::format("message '{}' came where '{}' was expected", *name, message.declaration->name));
    }
    return Reading(*message.declaration).parts(parse_json(text), message, true);
}

}  // namespace mw::messages
