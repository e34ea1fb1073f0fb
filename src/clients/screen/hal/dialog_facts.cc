// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/screen/hal/dialog_facts.hh"

#include <algorithm>
#include <optional>

#include "base/text.hh"

namespace mw::screen {
namespace {

using ini::IniEntry;

/// Parses "okdialog status"; nothing if a word is unknown.
std::optional<DialogKind> parse_kind(const std::string &text) {
    DialogKind kind;
    for (const std::string &word : split_words(text)) {
        if (word == "okdialog") {
            kind.isOk = true;
        } else if (word == "yesnodialog" || word == "dialog") {
            kind.isYesNo = true;
        } else if (word == "nonedialog") {
            kind.isLasting = true;
        } else if (word == "status") {
            kind.isStatus = true;
        } else {
            return std::nullopt;
        }
    }
    const bool any = kind.isOk || kind.isYesNo || kind.isLasting || kind.isStatus;
    return any ? std::optional(kind) : std::nullopt;
}

bool isPinName(const std::string &name) {
    return !name.empty() && name.size() <= 64 && std::ranges::all_of(name, [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_' || c == '.';
    });
}

void set_kind(DialogFacts &facts, const IniEntry &type, diagnostics::Sink &sink) {
    const auto kind = parse_kind(type.value);
    if (!kind.has_value()) {
        sink.error(
            "[DISPLAY]" + type.key + " is '" + type.value +
                "': valid types are okdialog, yesnodialog, nonedialog, status, or one of these with status",
            type.place);
    }
    facts.kind = kind.value_or(DialogKind{});
}

/// Entries of one type are in the order of the messages.
std::vector<DialogFacts> single_messages(const ini::IniFile &ini, diagnostics::Sink &sink) {
    const auto all = [&ini](const char *key) { return ini.find_all("DISPLAY", key); };
    const auto texts = all("MESSAGE_TEXT"), types = all("MESSAGE_TYPE"), pins = all("MESSAGE_PINNAME");
    const auto titles = all("MESSAGE_BOLDTEXT"), details = all("MESSAGE_DETAILS"),
               icons = all("MESSAGE_ICON");
    if (texts.size() != pins.size() || types.size() != pins.size()) {
        const IniEntry *const first = pins.empty() ? (texts.empty() ? types[0] : texts[0]) : pins[0];
        sink.error("[DISPLAY] has " + std::to_string(pins.size()) + " MESSAGE_PINNAME, " +
                       std::to_string(texts.size()) + " MESSAGE_TEXT and " + std::to_string(types.size()) +
                       " MESSAGE_TYPE: each message needs all three; the screen shows no message",
                   first->place);
        return {};
    }
    const auto value = [](const std::vector<const IniEntry *> &entries, std::size_t i) {
        return i < entries.size() ? entries[i]->value : std::string();
    };
    std::vector<DialogFacts> messages;
    for (std::size_t i = 0; i < pins.size(); ++i) {
        DialogFacts one{pins[i]->value, 0, {}, value(titles, i), texts[i]->value, value(details, i),
                        value(icons, i)};
        set_kind(one, *types[i], sink);
        messages.push_back(std::move(one));
    }
    return messages;
}

/// NUMBER begins the next message of an ID.
std::vector<DialogFacts> numbered_messages(const ini::IniFile &ini, const std::string &id,
                                           diagnostics::Sink &sink) {
    const std::string prefix = "MULTIMESSAGE_" + id + '_';
    std::vector<DialogFacts> messages;
    for (const IniEntry &entry : ini.entries()) {
        if (entry.section != "DISPLAY" || !entry.key.starts_with(prefix)) {
            continue;
        }
        const std::string key = entry.key.substr(prefix.size());
        if (key == "NUMBER") {
            constexpr std::int64_t MOST = INT32_MAX;
            const auto number = parse_int(entry.value);
            if (!number.has_value() || *number == 0 || *number < -MOST || *number > MOST) {
                sink.error("[DISPLAY]" + entry.key + " is '" + entry.value +
                               "': a whole number other than 0 is expected",
                           entry.place);
            }
            messages.push_back({id, static_cast<std::int32_t>(number.value_or(0)), {}, "", "", "", ""});
            continue;
        }
        if (messages.empty()) {
            sink.error("[DISPLAY]" + entry.key + " must follow the " + prefix + "NUMBER that it belongs to",
                       entry.place);
            return {};
        }
        DialogFacts &last = messages.back();
        if (key == "TYPE") {
            set_kind(last, entry, sink);
        } else if (key == "TITLE" || key == "TEXT" || key == "DETAILS" || key == "ICON") {
            (key == "TITLE"  ? last.title
             : key == "TEXT" ? last.text
             : key == "ICON" ? last.icon
                             : last.details) = entry.value;
        } else {
            sink.warning("[DISPLAY]" + entry.key + " is not known to this screen", entry.place);
        }
    }
    return messages;
}

}  // namespace

std::vector<DialogFacts> dialog_facts(const ini::IniFile &ini, diagnostics::Sink &sink) {
    std::vector<DialogFacts> all = single_messages(ini, sink);
    for (const IniEntry *id : ini.find_all("DISPLAY", "MULTIMESSAGE_ID")) {
        for (DialogFacts &one : numbered_messages(ini, id->value, sink)) {
            all.push_back(std::move(one));
        }
    }
    std::erase_if(all, [&sink, &ini](const DialogFacts &one) {
        const bool is_kind = one.kind.isOk || one.kind.isYesNo || one.kind.isLasting || one.kind.isStatus;
        const IniEntry *const place =
            ini.find("DISPLAY", one.number == 0 ? "MESSAGE_PINNAME" : "MULTIMESSAGE_ID");
        if (!isPinName(one.id)) {
            sink.error("'" + one.id + "' is not a pin name: use letters, digits, -, _ and .",
                       place != nullptr ? place->place : SourcePlace{});
        }
        return !is_kind || !isPinName(one.id);
    });
    return all;
}

}  // namespace mw::screen
