// SPDX-License-Identifier: GPL-2.0-or-later
#include "messages/declarations/reference.hh"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "messages/declarations/catalogue.hh"
#include "messages/declarations/value.hh"

namespace mw::messages {
namespace {

std::string kind_text(const Type &type) {
    switch (type.kind) {
    case Kind::BOOL: return "bool";
    case Kind::INTEGER: return fmt::format("s{}", 8 * type.bytes);
    case Kind::UNSIGNED: return fmt::format("u{}", 8 * type.bytes);
    case Kind::REAL: return "real";
    case Kind::NAMED: {
        std::string names;
        for (const Name &name : type.names) {
            names += fmt::format("{}{} {}", names.empty() ? "" : ", ", name.name, name.value);
        }
        return names;
    }
    case Kind::TEXT:
    case Kind::FIXED_TEXT: return "text";
    case Kind::PARTS: return type.parts->name;
    }
    return {};
}

std::string type_text(const Field &field) {
    const std::string kind = kind_text(field.type);
    if (field.type.list != nullptr) {
        return fmt::format("list of {}", kind);
    }
    return field.type.isArray ? fmt::format("{}[{}]", kind, field.type.count) : kind;
}

std::string range_text(const Field &field) {
    const Range &range = field.range;
    const bool is_text = field.type.kind == Kind::TEXT || field.type.kind == Kind::FIXED_TEXT;
    const double most =
        is_text && std::isinf(range.max) ? static_cast<double>(longest_text(field)) : range.max;
    const double least = is_text && std::isinf(range.min) ? 0 : range.min;
    const std::string what = is_text ? " bytes" : field.type.list != nullptr ? " entries" : "";
    if (std::isinf(least) && std::isinf(most)) {
        return "";
    }
    return std::isinf(most) ? fmt::format("at least {:g}{}", least, what)
                            : fmt::format("{:g} to {:g}{}", least, most, what);
}

void append(const Declaration &declaration, std::string &page) {
    page += fmt::format("\n### {}\n", declaration.name);
    if (declaration.number != 0) {
        page += fmt::format("{}: ", declaration.number);
    }
    page += fmt::format("{}.\n", declaration.doc);
    if (declaration.fields.empty()) {
        return;
    }
    page += "\n| field | type | range | unit | meaning |\n|---|---|---|---|---|\n";
    for (const Field &field : declaration.fields) {
        page += fmt::format("| `{}`{} | {} | {} | {} | {} |\n", field.name,
                            field.presence == Presence::OPTIONAL ? " (optional)" : "", type_text(field),
                            range_text(field), field.unit, field.doc);
    }
}

}  // namespace

std::string reference_page() {
    std::string page =
        "# Messages\n"
        "\n"
        "Generated from the declarations in `src/messages/declarations`.\n"
        "NML names: `nml_messages.md`. JSON: "
        "`{\"message\":\"JogStop\",\"is_joint\":true,"
        "\"index\":0}`;\n"
        "binary: `src/messages/declarations/binary.hh`. Each command ends with an outcome: done,\n"
        "or rejected or failed with a reason.\n"
        "\n"
        "## Commands\n";
    std::vector<const Declaration *> commands(command_declarations().begin(), command_declarations().end());
    std::sort(commands.begin(), commands.end(),
              [](const Declaration *a, const Declaration *b) { return a->number < b->number; });
    for (const Declaration *command : commands) {
        append(*command, page);
    }
    page += "\n## Status\n";
    for (const Declaration *status : status_declarations()) {
        append(*status, page);
    }
    return page;
}

}  // namespace mw::messages
