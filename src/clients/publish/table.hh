// SPDX-License-Identifier: GPL-2.0-or-later
// The published values of a machine: one row for each value, with its names in Sparkplug B and in MTConnect.
// A test compares the table with the declaration of the status: each field is in a row or in the list of
// fields that are not published.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "clients/publish/value.hh"
#include "messages/declarations/status.hh"

namespace mw::publish {

/// Objects for which a row is published. '#' in a name is replaced by the letter or number.
enum class Each : std::uint8_t { ONCE, AXIS, JOINT, SPINDLE };

/// The component of MTConnect with the data item.
enum class Component : std::uint8_t { NONE, DEVICE, CONTROLLER, PATH, AXIS, SPINDLE };

enum class Category : std::uint8_t { SAMPLE, EVENT, CONDITION };

/// Format of a value in MTConnect, whose units and words are fixed.
enum class Form : std::uint8_t {
    PLAIN,
    LENGTH,     ///< machine units to millimetres
    PERCENT,    ///< 1.0 is 100
    PER_MIN,    ///< revolutions per second to revolutions per minute
    STOPPED,    ///< the emergency stop, from the state
    MODE,       ///< the mode of operation
    DIRECTION,  ///< direction of a spindle
    WORK,       ///< G54 ... G59.3 by number
    FILE,       ///< a path without its folders
    FAULT,      ///< a text is a fault; without a text the condition is normal
};

/// A data item of MTConnect. An item of an axis has type `type` for lengths, ANGLE in DEGREE for angles.
struct Item {
    Component component = Component::NONE;
    Category category = Category::EVENT;
    const char *type = "";
    const char *sub_type = "";
    const char *units = "";
    Form form = Form::PLAIN;
};

struct Row {
    const char *metric;  ///< name in Sparkplug; folders are separated by '/'
    const char *fields;  ///< path in the status, "task.state"; for a calculated value all paths that it uses
    Each each = Each::ONCE;
    double deadband = 0;  ///< a smaller change is not published [unit of the field]; 0: each change is
                          ///< published
    Item item{};
    /// Function of a calculated value; null: the field itself.
    Value (*calculate)(const messages::MachineStatus &status, int index) = nullptr;
    const char *doc = "";  ///< description of a calculated value
};

/// A field that is not published, or a part of the status without published fields.
struct NotPublished {
    const char *field;
    const char *reason;
};

std::span<const Row> rows();
std::span<const NotPublished> not_published();

/// Messages to the operator, which are not part of the status.
inline constexpr const char *MESSAGE_METRIC = "Messages/Text";
inline constexpr const char *MESSAGE_TYPE_METRIC = "Messages/Type";
inline constexpr const char *MESSAGE_ID_METRIC = "Messages/Id";

/// The reference page of published values, published.md.
std::string published_page();

}  // namespace mw::publish
