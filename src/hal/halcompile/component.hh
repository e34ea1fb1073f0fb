// SPDX-License-Identifier: GPL-2.0-or-later
// What a .comp file declares: the tree that the parser makes, the checker looks at and the emitters write
// from.
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
    std::string count;  ///< C expression of personality; empty: all of them
};

/// A pin or a parameter.
struct Item {
    SourcePlace place;
    bool isPin = true;
    Direction direction = Direction::IN;
    ValueType type = ValueType::BIT;
    std::string name;  ///< as written, with its dashes, dots and hash marks
    std::optional<ArraySize> array;
    std::string condition;    ///< C expression of personality; empty: always there
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
    std::string value;  ///< "yes" when none is written
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

/// A paragraph of the manual page, or an include or a struct: text with its place.
struct Text {
    SourcePlace place;
    std::string text;
};

struct Component {
    std::string file;  ///< as errors name it
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
    std::string code;      ///< what follows ;;
    int code_line = 1;     ///< where it starts
    bool hasCode = false;  ///< there was a ;;

    const Option *option(std::string_view name) const;
    /// The value of a yes/no option.
    bool isOn(std::string_view name, bool otherwise = false) const;
    /// True when a condition or an array size depends on the personality.
    bool hasPersonality() const;
    bool isUserspace() const { return isOn("userspace"); }
};

/// "yes", "true" and other than zero numbers.
std::optional<bool> parse_switch(std::string_view text);

/// The name of an item as C code sees it: x.##.y is x_y, out-# is out.
std::string c_name(std::string_view name);
/// The name as HAL sees it, hash marks still in it: x_y_ is x-y, _ is empty.
std::string hal_name(std::string_view name);
/// The component's name in front of its pins: without a leading hal_, with dashes.
std::string hal_prefix(const Component &component);

const char *type_word(ValueType type);
const char *direction_word(Direction direction);

}  // namespace mw::halcompile
