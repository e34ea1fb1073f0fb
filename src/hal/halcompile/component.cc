// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/halcompile/component.hh"

#include <algorithm>

#include "base/text.hh"

namespace mw::halcompile {

const Option *Component::option(std::string_view wanted) const {
    const auto found = std::find_if(options.begin(), options.end(),
                                    [&](const Option &option) { return option.name == wanted; });
    return found == options.end() ? nullptr : &*found;
}

bool Component::isOn(std::string_view wanted, bool otherwise) const {
    const Option *found = option(wanted);
    return found == nullptr ? otherwise : parse_switch(found->value).value_or(otherwise);
}

bool Component::hasPersonality() const {
    return isOn("personality") || std::any_of(items.begin(), items.end(), [](const Item &item) {
               return !item.condition.empty() || (item.array && !item.array->count.empty());
           });
}

std::optional<bool> parse_switch(std::string_view text) {
    const std::string word = to_lower(text);
    if (word == "yes" || word == "true" || word == "y") {
        return true;
    }
    if (word == "no" || word == "false" || word == "n") {
        return false;
    }
    const auto number = parse_int(word);
    return number ? std::optional<bool>(*number != 0) : std::nullopt;
}

std::string c_name(std::string_view name) {
    std::string out;
    for (const char c : name) {
        if (c == '#') {
            while (!out.empty() && out.back() == '_') {
                out.pop_back();
            }
            continue;
        }
        const char letter = c == '.' || c == '-' ? '_' : c;
        if (letter != '_' || out.empty() || out.back() != '_') {
            out += letter;
        }
    }
    return out;
}

std::string hal_name(std::string_view name) {
    std::string out(name);
    std::replace(out.begin(), out.end(), '_', '-');
    while (!out.empty() && (out.back() == '-' || out.back() == '.')) {
        out.pop_back();
    }
    return out;
}

std::string hal_prefix(const Component &component) {
    const std::string_view name = component.name;
    return hal_name(name.starts_with("hal_") ? name.substr(4) : name);
}

const char *type_word(ValueType type) {
    switch (type) {
    case ValueType::BIT: return "bit";
    case ValueType::FLOAT: return "float";
    case ValueType::S32: return "s32";
    case ValueType::U32: return "u32";
    case ValueType::S64: return "s64";
    case ValueType::U64: return "u64";
    case ValueType::PORT: return "port";
    }
    return "";
}

const char *direction_word(Direction direction) {
    switch (direction) {
    case Direction::IN: return "in";
    case Direction::OUT: return "out";
    case Direction::IO: return "io";
    case Direction::RO: return "r";
    case Direction::RW: return "rw";
    }
    return "";
}

}  // namespace mw::halcompile
