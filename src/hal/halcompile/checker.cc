// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/halcompile/checker.hh"

#include <algorithm>
#include <array>
#include <limits>
#include <map>

#include <fmt/core.h>

#include "base/text.hh"
#include "hal/halcompile/code.hh"

namespace mw::halcompile {
namespace {

enum class OptionKind { SWITCH, NUMBER, TEXT };
struct KnownOption {
    std::string_view name;
    OptionKind kind;
};
constexpr std::array<KnownOption, 18> OPTIONS{{{"singleton", OptionKind::SWITCH},
                                               {"default_count", OptionKind::NUMBER},
                                               {"count_function", OptionKind::SWITCH},
                                               {"rtapi_app", OptionKind::SWITCH},
                                               {"data", OptionKind::TEXT},
                                               {"extra_setup", OptionKind::SWITCH},
                                               {"extra_cleanup", OptionKind::SWITCH},
                                               {"post_export", OptionKind::SWITCH},
                                               {"userspace", OptionKind::SWITCH},
                                               {"userinit", OptionKind::SWITCH},
                                               {"extra_link_args", OptionKind::TEXT},
                                               {"extra_compile_args", OptionKind::TEXT},
                                               {"homemod", OptionKind::SWITCH},
                                               {"tpmod", OptionKind::SWITCH},
                                               {"constructable", OptionKind::SWITCH},
                                               {"period", OptionKind::SWITCH},
                                               {"period_used", OptionKind::SWITCH},
                                               {"personality", OptionKind::SWITCH}}};

constexpr std::array<std::string_view, 37> C_WORDS{
    "auto",     "break",  "case",   "char",     "const",     "continue", "default",  "do",
    "double",   "else",   "enum",   "extern",   "float",     "for",      "goto",     "if",
    "inline",   "int",    "long",   "register", "restrict",  "return",   "short",    "signed",
    "sizeof",   "static", "struct", "switch",   "typedef",   "union",    "unsigned", "void",
    "volatile", "while",  "_Bool",  "_Complex", "_Imaginary"};
constexpr std::array<std::string_view, 8> RESERVED{"comp_id",        "fperiod",     "rtapi_app_main",
                                                   "rtapi_app_exit", "extra_setup", "extra_cleanup",
                                                   "post_export",    "period"};
/// Names that are reserved only in components whose code can use them.
constexpr std::array<std::string_view, 2> OF_SETUP{"prefix", "extra_arg"};

constexpr std::size_t LONGEST_NAME = 127;  // limit of HAL

template <class List>
bool has(const List &list, std::string_view name) {
    return std::find(list.begin(), list.end(), name) != list.end();
}

class Checker {
  public:
    Checker(const Component &component, diagnostics::Sink &sink) : component_(component), sink_(sink) {}

    void run(const std::string &base_name) {
        check_component(base_name);
        for (const Option &option : component_.options) {
            check_option(option);
        }
        for (const Item &item : component_.items) {
            check_item(item);
        }
        for (const Function &function : component_.functions) {
            claim(c_name(function.name), function.place, "function");
        }
        for (const Variable &variable : component_.variables) {
            claim(variable.name, variable.place, "variable");
        }
        for (const ModuleParameter &parameter : component_.parameters) {
            check_parameter(parameter);
        }
        check_functions();
        check_code_of_options();
    }

  private:
    void check_component(const std::string &base_name) {
        if (component_.name.empty()) {
            sink_.error("there is no 'component' declaration", {component_.file, 1, 1},
                        fmt::format("start with: component {};", base_name));
        } else if (component_.name != base_name) {
            sink_.error(fmt::format("component '{}' is in a file named {}", component_.name, base_name),
                        component_.place, "the names of component and file must be the same");
        } else if (component_.name.find_first_of("-.#") != std::string::npos) {
            sink_.error(fmt::format("'{}' is not a valid component name", component_.name), component_.place,
                        "use letters, digits and _");
        }
        if (!component_.has_code) {
            sink_.error("there is no ;;", {component_.file, 0, 0},
                        "it must be on a separate line between declarations and code");
        }
        if (!component_.license) {
            sink_.warning("there is no license", component_.place, "for example: license \"GPL\";");
        }
    }

    void check_option(const Option &option) {
        const auto known = std::find_if(OPTIONS.begin(), OPTIONS.end(),
                                        [&](const KnownOption &one) { return one.name == option.name; });
        if (known == OPTIONS.end()) {
            std::vector<std::string> names;
            for (const KnownOption &one : OPTIONS) {
                names.emplace_back(one.name);
            }
            const std::string near = nearest_name(option.name, names);
            sink_.warning(fmt::format("option '{}' is not known and has no effect", option.name),
                          option.place, near.empty() ? "" : fmt::format("did you mean '{}'?", near));
            return;
        }
        if (known->kind == OptionKind::SWITCH && !parse_switch(option.value)) {
            sink_.error(fmt::format("option {} is '{}'", option.name, option.value), option.place,
                        "use yes or no");
        }
        const auto number = parse_int(option.value);
        if (known->kind == OptionKind::NUMBER && (!number || *number < 0 || *number > 10000)) {
            sink_.error(fmt::format("option {} is '{}'", option.name, option.value), option.place,
                        "use a number from 0 to 10000");
        }
    }

    void claim(const std::string &name, const SourcePlace &place, const char *what) {
        if (name.size() > LONGEST_NAME) {
            sink_.error(fmt::format("a name has more than {} characters", LONGEST_NAME), place);
            return;
        }
        const auto [at, isNew] = names_.emplace(name, place);
        if (!isNew) {
            sink_.error(fmt::format("the name '{}' is already in use", name), place,
                        fmt::format("by the declaration in line {}", at->second.line));
        }
        if (has(C_WORDS, name)) {
            sink_.error(fmt::format("'{}' is a C keyword", name), place,
                        fmt::format("call the {} {}_; HAL shows it without the trailing _", what, name));
        }
        const bool of_setup =
            has(OF_SETUP, name) && (component_.isOn("extra_setup") || component_.isOn("post_export"));
        const bool exported = name == "export" && !component_.isOn("rtapi_app", true);
        if (has(RESERVED, name) || of_setup || exported || name.starts_with("__comp")) {
            sink_.error(fmt::format("the name '{}' is reserved", name), place,
                        fmt::format("call the {} {}_", what, name));
        }
        if (name == "personality" && component_.hasPersonality()) {
            sink_.error("the name 'personality' is reserved for the personality of the instance", place);
        }
    }

    void check_item(const Item &item) {
        const char *what = item.isPin ? "pin" : "parameter";
        claim(c_name(item.name), item.place, what);
        const bool has_hash = item.name.find('#') != std::string::npos;
        if (has_hash && !item.array) {
            sink_.error(fmt::format("'{}' has # but no [SIZE]", item.name), item.place);
        }
        if (!has_hash && item.array) {
            sink_.error(fmt::format("'{}' has a [SIZE] but no #", item.name), item.place,
                        fmt::format("the # are replaced by the number of the element: {}-##", item.name));
        }
        if (has_hash &&
            item.name.find('#', item.name.find_first_not_of('#', item.name.find('#'))) != std::string::npos) {
            sink_.error(fmt::format("'{}' has # at two positions", item.name), item.place);
        }
        if (item.array) {
            check_size(*item.array, item);
        }
        if (item.type == ValueType::PORT && !item.isPin) {
            sink_.error("a parameter cannot be a port", item.place);
        }
        check_start(item);
    }

    void check_size(const ArraySize &array, const Item &item) {
        const auto size = parse_int(array.size);
        if (array.size.empty() || (size && (*size < 1 || *size > 4096))) {
            sink_.error(fmt::format("'{}' has the size '{}'", item.name, array.size), item.place,
                        "use a number from 1 to 4096");
        }
    }

    void check_start(const Item &item) {
        if (item.start_value.empty()) {
            return;
        }
        const auto number = parse_double(item.start_value);
        const auto integer = parse_int(item.start_value);
        const auto is_out = [&](double low, double high) {
            return number && (*number < low || *number > high);
        };
        const bool is_fraction =
            number && !integer && *number != static_cast<double>(static_cast<long long>(*number));
        const char *expected = nullptr;
        switch (item.type) {
        case ValueType::BIT: expected = is_out(0, 1) || is_fraction ? "0, 1, TRUE or FALSE" : nullptr; break;
        case ValueType::S32:
            expected =
                is_out(std::numeric_limits<std::int32_t>::min(), std::numeric_limits<std::uint32_t>::max()) ||
                        is_fraction
                    ? "a whole number of 32 bits"
                    : nullptr;
            break;
        case ValueType::U32:
            expected = is_out(0, std::numeric_limits<std::uint32_t>::max()) || is_fraction
                           ? "a whole number of 32 bits, not negative"
                           : nullptr;
            break;
        case ValueType::S64:
        case ValueType::U64: expected = is_fraction ? "a whole number of 64 bits" : nullptr; break;
        case ValueType::PORT: expected = "nothing: a port has no start value"; break;
        case ValueType::FLOAT: break;
        }
        if (expected != nullptr) {
            sink_.error(fmt::format("'{}' starts with {}", item.name, item.start_value), item.place,
                        fmt::format("a {} takes {}", type_word(item.type), expected));
        }
    }

    void check_parameter(const ModuleParameter &parameter) {
        static constexpr std::array<std::string_view, 10> TYPES{
            "int", "long",          "unsigned", "unsigned int", "u32",
            "s32", "unsigned long", "string",   "char*",        "dummy"};
        if (std::find(TYPES.begin(), TYPES.end(), parameter.type) == TYPES.end()) {
            sink_.error(fmt::format("'{}' is not a type of a module parameter", parameter.type),
                        parameter.place,
                        "use int, long, string, or dummy for a parameter that the code declares");
        }
        if (parameter.type != "dummy") {
            claim(parameter.name, parameter.place, "module parameter");
        }
    }

    /// Each declared function needs a FUNCTION(name) in the code, and vice versa.
    void check_functions() {
        if (component_.isUserspace() && !component_.functions.empty()) {
            sink_.error("a userspace component has no functions", component_.functions.front().place,
                        "its code is in user_mainloop()");
            return;
        }
        const CodeFacts facts = look_at_code(component_.code);
        if (facts.deep.has_value()) {
            sink_.error(fmt::format("the code has more than {} nested '{}'", MOST_NESTED, facts.deep->name),
                        {component_.file, component_.code_line + facts.deep->line, facts.deep->column});
            return;
        }
        const bool is_body = !facts.has_function_word && component_.functions.size() == 1;
        if (is_body || component_.isUserspace()) {
            return;
        }
        std::vector<std::string> declared;
        for (const Function &function : component_.functions) {
            declared.push_back(c_name(function.name));
            const bool defined =
                std::any_of(facts.functions.begin(), facts.functions.end(),
                            [&](const auto &one) { return c_name(one.name) == declared.back(); });
            if (!defined && !facts.has_quoted_include) {
                sink_.error(fmt::format("function '{}' is not defined", function.name), function.place,
                            fmt::format("its code starts with FUNCTION({})", declared.back()));
            }
        }
        for (const CodeFacts::Use &use : facts.functions) {
            if (std::find(declared.begin(), declared.end(), c_name(use.name)) == declared.end()) {
                const std::string near = nearest_name(use.name, declared);
                sink_.error(fmt::format("FUNCTION({}) is not declared", use.name),
                            {component_.file, component_.code_line + use.line, use.column},
                            near.empty() ? fmt::format("declare it above ;; with: function {};", use.name)
                                         : fmt::format("did you mean '{}'?", near));
            }
        }
    }

    /// Options that need code, and code that needs an option.
    void check_code_of_options() {
        struct Pair {
            std::string_view option, word;
            bool is_macro;
        };
        static constexpr std::array<Pair, 6> PAIRS{{{"extra_setup", "EXTRA_SETUP", true},
                                                    {"extra_cleanup", "EXTRA_CLEANUP", true},
                                                    {"post_export", "POST_EXPORT", true},
                                                    {"count_function", "get_count", false},
                                                    {"userinit", "userinit", false},
                                                    {"userspace", "user_mainloop", false}}};
        const CodeFacts facts = look_at_code(component_.code);
        if (facts.has_quoted_include || !component_.has_code) {
            return;
        }
        for (const Pair &pair : PAIRS) {
            const bool on =
                component_.isOn(pair.option) && (pair.option != "userinit" || component_.isUserspace());
            const bool present = facts.words.contains(pair.word);
            if (on && !present) {
                sink_.error(fmt::format("option {} is on, but there is no {}", pair.option, pair.word),
                            component_.option(pair.option)->place);
            } else if (!on && present && pair.is_macro) {
                sink_.warning(fmt::format("{} is never called", pair.word), component_.place,
                              fmt::format("it needs: option {};", pair.option));
            }
        }
        if (!component_.isOn("rtapi_app", true) && !facts.words.contains("rtapi_app_main")) {
            sink_.error("option rtapi_app is off, but there is no rtapi_app_main",
                        component_.option("rtapi_app")->place);
        }
    }

    const Component &component_;
    diagnostics::Sink &sink_;
    std::map<std::string, SourcePlace> names_;
};

}  // namespace

void check(const Component &component, const std::string &base_name, diagnostics::Sink &sink) {
    Checker(component, sink).run(base_name);
}

}  // namespace mw::halcompile
