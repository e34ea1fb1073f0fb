// SPDX-License-Identifier: GPL-2.0-or-later
#include "messages/declarations/text.hh"

#include <fmt/format.h>

#include "messages/declarations/task_status.hh"
#include "messages/declarations/value.hh"

namespace mw::messages {

std::string quoted(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        const auto code = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') {
            out += '\\';
            out += c;
        } else {
            out += code < 0x20 || code == 0x7f ? fmt::format("\\x{:02x}", code) : std::string(1, c);
        }
    }
    return out + '"';
}

namespace {

void append_fields(const ConstObject &message, const std::string &prefix, std::string &line);

std::string element_text(const Field &field, const void *at) {
    const Type &type = field.type;
    switch (type.kind) {
    case Kind::BOOL: return get_integer(type, at) != 0 ? "true" : "false";
    case Kind::INTEGER: return std::to_string(get_integer(type, at));
    case Kind::UNSIGNED: return std::to_string(static_cast<std::uint64_t>(get_integer(type, at)));
    case Kind::REAL: return fmt::format("{:g}", get_real(at));
    case Kind::NAMED: {
        const std::int64_t value = get_integer(type, at);
        const char *name = name_of(type, value);
        return name == nullptr ? std::to_string(value) : name;
    }
    case Kind::TEXT:
    case Kind::FIXED_TEXT: return quoted(get_text(type, at));
    case Kind::PARTS: {
        std::string line;
        append_fields({type.parts, at}, "", line);
        return '{' + line + '}';
    }
    }
    return {};
}

void append_fields(const ConstObject &message, const std::string &prefix, std::string &line) {
    for (const Field &field : message.declaration->fields) {
        const void *at = field.at(const_cast<void *>(message.data));
        line += (line.empty() ? "" : " ") + prefix + field.name + '=';
        if (!isSeries(field.type)) {
            line += element_text(field, at);
            continue;
        }
        const std::size_t count = count_elements(field.type, at);
        line += '[';
        for (std::size_t i = 0; i < count; ++i) {
            line += (i == 0 ? "" : " ") + element_text(field, element(field.type, at, i));
        }
        line += ']';
    }
}

}  // namespace

std::string to_text(const ConstObject &message) {
    std::string line = message.declaration->name;
    append_fields(message, "", line);
    return line;
}

std::string waiting_text(const Waiting &waiting) {
    switch (waiting.what) {
    case WaitFor::NOTHING: return {};
    case WaitFor::DWELL: return "the end of a dwell";
    case WaitFor::DIGITAL_INPUT: return fmt::format("pin motion.digital-in-{:02}", waiting.index);
    case WaitFor::ANALOG_INPUT: return fmt::format("pin motion.analog-in-{:02}", waiting.index);
    case WaitFor::TOOL_PREPARED: return "pin iocontrol.0.tool-prepared to become TRUE";
    case WaitFor::TOOL_PREPARED_OFF: return "pin iocontrol.0.tool-prepared to become FALSE";
    case WaitFor::TOOL_CHANGED: return "pin iocontrol.0.tool-changed to become TRUE";
    case WaitFor::TOOL_START_CHANGE: return "pin iocontrol.0.start-change-ack";
    case WaitFor::TOOL_ABORT_TAKEN: return "pin iocontrol.0.emc-abort-ack";
    case WaitFor::TOOL_DATA: return "the tool data";
    case WaitFor::TOOL_CHANGED_OFF: return "pin iocontrol.0.tool-changed to become FALSE";
    case WaitFor::SPINDLE_ORIENTED: return fmt::format("pin spindle.{}.is-oriented", waiting.index);
    case WaitFor::SETTING: return "the motion controller to take a setting";
    case WaitFor::USER_CODE: return "a user M code to end";
    case WaitFor::HOMING: return "homing";
    }
    return {};
}

}  // namespace mw::messages
