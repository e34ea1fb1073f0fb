// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/publish/field_path.hh"

#include <algorithm>

#include "messages/declarations/value.hh"

namespace mw::publish {
namespace {

using messages::Declaration;
using messages::Field;
using messages::Kind;

const Field *find_field(const Declaration &declaration, std::string_view name) {
    const auto found =
        std::ranges::find_if(declaration.fields, [name](const Field &field) { return name == field.name; });
    return found == declaration.fields.end() ? nullptr : &*found;
}

void list(const Declaration &declaration, const std::string &before, std::vector<std::string> &into) {
    for (const Field &field : declaration.fields) {
        const std::string path = before + field.name;
        if (field.type.kind == Kind::PARTS) {
            list(*field.type.parts, path + '.', into);
        } else {
            into.push_back(path);
        }
    }
}

DataType type_of(const Value &value) {
    switch (value.index()) {
    case 1: return DataType::BOOLEAN;
    case 2: return DataType::INT64;
    case 3: return DataType::UINT64;
    case 5: return DataType::STRING;
    default: return DataType::DOUBLE;
    }
}

}  // namespace

std::optional<FieldPath> FieldPath::find(std::string_view path) {
    FieldPath found;
    const Declaration *declaration = &messages::DECLARATION<messages::MachineStatus>;
    while (declaration != nullptr && found.count_ < MOST) {
        const std::size_t dot = path.find('.');
        const Field *field = find_field(*declaration, path.substr(0, dot));
        if (field == nullptr) {
            return std::nullopt;
        }
        found.fields_[found.count_++] = field;
        declaration = field->type.kind == Kind::PARTS ? field->type.parts : nullptr;
        const bool isEnd = dot == std::string_view::npos;
        if (isEnd) {
            return declaration == nullptr ? std::optional(found) : std::nullopt;
        }
        path.remove_prefix(dot + 1);
    }
    return std::nullopt;
}

std::string_view FieldPath::first_of(std::string_view paths) {
    return paths.substr(0, paths.find(' '));
}

Value FieldPath::read(const messages::MachineStatus &status, int index) const {
    // The accessors of a declaration take a non-const object, but nothing is written here.
    void *at = const_cast<messages::MachineStatus *>(&status);
    for (std::size_t i = 0; i < count_; ++i) {
        const messages::Type &type = fields_[i]->type;
        at = fields_[i]->at(at);
        if (type.isArray) {
            const std::size_t most = type.count - 1;
            at = messages::element(type, at, std::min(static_cast<std::size_t>(std::max(index, 0)), most));
        }
    }
    const messages::Type &type = last().type;
    switch (type.kind) {
    case Kind::BOOL: return messages::get_integer(type, at) != 0;
    case Kind::INTEGER: return messages::get_integer(type, at);
    case Kind::UNSIGNED: return static_cast<std::uint64_t>(messages::get_integer(type, at));
    case Kind::REAL: return messages::get_real(at);
    case Kind::NAMED: {
        const char *name = messages::name_of(type, messages::get_integer(type, at));
        return name == nullptr ? Value() : Value(std::string(name));
    }
    case Kind::TEXT:
    case Kind::FIXED_TEXT: return clean_text(messages::get_text(type, at));
    case Kind::PARTS: break;
    }
    return {};
}

std::vector<std::string> all_fields() {
    std::vector<std::string> all;
    list(messages::DECLARATION<messages::MachineStatus>, "", all);
    return all;
}

DataType type_of(const Row &row) {
    if (row.calculate != nullptr) {
        messages::MachineStatus status;
        status.trajectory.isPositionValid = true;
        return type_of(row.calculate(status, 0));
    }
    const auto path = FieldPath::find(row.fields);
    switch (path->type().kind) {
    case Kind::BOOL: return DataType::BOOLEAN;
    case Kind::INTEGER: return DataType::INT64;
    case Kind::UNSIGNED: return DataType::UINT64;
    case Kind::REAL: return DataType::DOUBLE;
    default: return DataType::STRING;
    }
}

}  // namespace mw::publish
