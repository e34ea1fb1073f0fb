// SPDX-License-Identifier: GPL-2.0-or-later
// The declarations of a .comp file: the tree that the parser builds, the checker reads and the emitters
// write.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/result.hh"

namespace mw::halcompile {

enum class ValueType { BIT, FLOAT, S32, U32, S64, U64, PORT };
enum class Direction { IN, OUT, IO, RO, RW };

/// [SIZE] or [MAXSIZE : CONDSIZE].
struct ArraySize {
    std::string size;   ///< a number or a C constant
    std::string count;  ///< C expression of the personality; empty: all elements
};

/// A pin or a parameter.
struct Item {
    SourcePlace place;
    bool isPin = true;
    Direction direction = Direction::IN;
    ValueType type = ValueType::BIT;
    std::string name;  ///< as in the file, with dashes, dots and hash marks
    std::optional<ArraySize> array;
    std::string condition;    ///< C expression of the personality; empty: always present
    std::string start_value;  ///< C expression; empty: 0
    std::string doc;
};

struct Function {
    SourcePlace place;
    std::string name;
    bool usesFloat = true;
    std::string doc;
};

struct Option {
    SourcePlace place;
    std::string name;
    std::string value;  ///< "yes" when missing
};

struct Variable {
    SourcePlace place;
    std::string type;
    std::string stars;
    std::string name;
    std::string size;         ///< of an array, else empty; several dimensions joined by "]["
    std::string start_value;  ///< C expression or {list}; empty: all bits zero
};

struct ModuleParameter {
    SourcePlace place;
    std::string type;  ///< int, long, unsigned..., string; "dummy": documented here, declared in the code
    std::string name;
    std::string size;
    std::string start_value;
    std::string doc;
};

/// A paragraph of the manual page, an include or a struct: text with its position.
struct Text {
    SourcePlace place;
    std::string text;
};

struct Component {
    std::string file;  ///< file name for errors
    SourcePlace place;
    std::string name;
    std::string doc;
    std::vector<Item> items;
    std::vector<Function> functions;
    std::vector<Option> options;
    std::vector<Variable> variables;
    std::vector<ModuleParameter> parameters;
    std::vector<Text> includes;    ///< with their quotes or brackets
    std::vector<Text> structures;  ///< C type definitions, complete with their semicolon
    std::optional<Text> description, examples, notes, see_also, license;
    std::vector<Text> authors;
    std::string code;       ///< text after ;;
    int code_line = 1;      ///< line of the file where the code starts
    bool has_code = false;  ///< the file has a ;;

    const Option *option(std::string_view name) const;
    /// The value of a yes/no option.
    bool isOn(std::string_view name, bool otherwise = false) const;
    /// A condition or an array size depends on the personality.
    bool hasPersonality() const;
    bool isUserspace() const { return isOn("userspace"); }
};

/// "yes", "true" and numbers other than zero.
std::optional<bool> parse_switch(std::string_view text);

/// Name of an item in C code: x.##.y is x_y, out-# is out.
std::string c_name(std::string_view name);
/// Name in HAL, including hash marks: x_y_ is x-y, _ is empty.
std::string hal_name(std::string_view name);
/// Prefix of the component's pins: its name without a leading hal_, with dashes.
std::string hal_prefix(const Component &component);

const char *type_word(ValueType type);
const char *direction_word(Direction direction);

}  // namespace mw::halcompile
