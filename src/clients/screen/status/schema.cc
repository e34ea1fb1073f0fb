// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/screen/status/schema.hh"

#include <cmath>
#include <span>

#include "clients/screen/http/json_text.hh"
#include "messages/declarations/catalogue.hh"
#include "messages/declarations/value.hh"

namespace mw::screen {
namespace {

const char *kind_name(messages::Kind kind) {
    switch (kind) {
    case messages::Kind::BOOL: return "bool";
    case messages::Kind::INTEGER: return "integer";
    case messages::Kind::UNSIGNED: return "unsigned";
    case messages::Kind::REAL: return "real";
    case messages::Kind::NAMED: return "name";
    case messages::Kind::TEXT:
    case messages::Kind::FIXED_TEXT: return "text";
    case messages::Kind::PARTS: return "parts";
    }
    return "";
}

Json field_document(const messages::Field &field) {
    const messages::Type &type = field.type;
    Json json{{"name", field.name}, {"type", kind_name(type.kind)}};
    if (type.kind == messages::Kind::PARTS) {
        json["parts"] = type.parts->name;
    }
    if (!type.names.empty()) {
        Json &names = json["names"] = Json::array();
        for (const messages::Name &name : type.names) {
            names.push_back(name.name);
        }
    }
    if (type.list != nullptr) {
        json["list"] = true;
    } else if (type.isArray) {
        json["count"] = type.count;
    }
    const bool is_text = type.kind == messages::Kind::TEXT || type.kind == messages::Kind::FIXED_TEXT;
    if (std::isfinite(field.range.min)) {
        json["min"] = field.range.min;
    }
    if (std::isfinite(field.range.max)) {
        json["max"] = field.range.max;
    } else if (is_text) {
        json["max"] = messages::longest_text(field);
    }
    json["unit"] = field.unit;
    json["doc"] = field.doc;
    if (field.presence == messages::Presence::OPTIONAL) {
        json["optional"] = true;
    }
    return json;
}

Json declaration_document(const messages::Declaration &declaration) {
    Json json{{"name", declaration.name}, {"number", declaration.number}, {"doc", declaration.doc}};
    Json &fields = json["fields"] = Json::array();
    for (const messages::Field &field : declaration.fields) {
        fields.push_back(field_document(field));
    }
    return json;
}

Json declarations_document(std::span<const messages::Declaration *const> declarations) {
    Json json = Json::array();
    for (const messages::Declaration *declaration : declarations) {
        json.push_back(declaration_document(*declaration));
    }
    return json;
}

}  // namespace

std::string schema_document() {
    return text_of(Json{{"commands", declarations_document(messages::command_declarations())},
                        {"status", declarations_document(messages::status_declarations())}});
}

}  // namespace mw::screen
