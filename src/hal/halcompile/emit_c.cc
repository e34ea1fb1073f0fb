// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/halcompile/emit_c.hh"

#include <algorithm>
#include <array>

#include <fmt/core.h>

#include "base/text.hh"
#include "hal/halcompile/code.hh"
#include "hal/halcompile/emit_main.hh"
#include "hal/halcompile/quote.hh"

namespace mw::halcompile {
namespace {

/// Kernel names of integer types in variables of components.
std::string plain_type(const std::string &type) {
    static constexpr std::array<std::string_view, 8> SHORT{"u8",  "s8",  "u16", "s16",
                                                           "u32", "s32", "u64", "s64"};
    for (const std::string_view one : SHORT) {
        if (one == type) {
            return "rtapi_" + type;
        }
    }
    return type;
}

const char *direction_constant(Direction direction) {
    switch (direction) {
    case Direction::IN: return "HAL_IN";
    case Direction::OUT: return "HAL_OUT";
    case Direction::IO: return "HAL_IO";
    case Direction::RO: return "HAL_RO";
    case Direction::RW: return "HAL_RW";
    }
    return "";
}

class Emitter {
  public:
    Emitter(const Component &component, int personalities)
        : component_(component), personalities_(personalities), prefix_(hal_prefix(component)) {}

    std::string run() {
        head();
        types();
        forward();
        put(emit_module_parameters(component_, personalities_));
        own_line();
        export_function();
        if (component_.isOn("rtapi_app", true)) {
            put(emit_app(component_, prefix_));
        }
        if (component_.isUserspace()) {
            put(emit_main(component_));
        }
        macros();
        code();
        return std::move(out_);
    }

  private:
    template <class... Args>
    void line(fmt::format_string<Args...> text, Args &&...args) {
        out_ += fmt::format(text, std::forward<Args>(args)...);
        out_ += '\n';
    }
    void put(std::string_view text) { out_ += text; }
    void source_line(const SourcePlace &place) { line("#line {} {}", place.line, c_string(place.file)); }

    /// Returns to the lines of the C file, after code with another #line.
    void own_line() {
        const auto lines = std::count(out_.begin(), out_.end(), '\n');
        line("#line {} {}", lines + 2, c_string(component_.name + ".c"));
    }

    void head() {
        line("/* Made by halcompile from {}.comp. Do not change it here. */", component_.name);
        put("#include \"rtapi.h\"\n");
        if (!component_.isUserspace()) {
            put("#include \"rtapi_app.h\"\n");
        }
        put("#include \"rtapi_string.h\"\n#include \"rtapi_errno.h\"\n#include \"rtapi_stdint.h\"\n"
            "#include \"hal.h\"\n#include <stdio.h>\n");
        for (const Text &include : component_.includes) {
            source_line(include.place);
            line("#include {}", include.text);
        }
        if (component_.license) {
            line("MODULE_LICENSE({});", c_string(component_.license->text));
        }
        for (const Text &author : component_.authors) {
            line("MODULE_AUTHOR({});", c_string(author.text));
        }
        if (!component_.doc.empty()) {
            line("MODULE_DESCRIPTION({});", c_string(component_.doc));
        }
        own_line();
        put("\nstatic int comp_id __attribute__((__unused__));\n");
    }

    void types() {
        for (const Text &structure : component_.structures) {
            source_line(structure.place);
            line("{}", structure.text);
        }
        put("\nstruct __comp_state {\n    struct __comp_state *_next;\n");
        if (component_.hasPersonality()) {
            put("    int _personality;\n");
        }
        for (const Item &item : component_.items) {
            source_line(item.place);
            line("    hal_{}_t {}{}{};", type_word(item.type), item.isPin ? "*" : "", c_name(item.name),
                 item.array ? "[" + item.array->size + "]" : "");
        }
        for (const Variable &variable : component_.variables) {
            source_line(variable.place);
            line("    {} {}{}{};", plain_type(variable.type), variable.stars, variable.name,
                 variable.size.empty() ? "" : "[" + variable.size + "]");
        }
        if (const Option *data = component_.option("data")) {
            source_line(data->place);
            line("    {} _data;", plain_type(data->value));
        }
        own_line();
        put("};\nstatic struct __comp_state *__comp_first_inst __attribute__((__unused__));\n"
            "static struct __comp_state *__comp_last_inst __attribute__((__unused__));\n");
        if (component_.isUserspace()) {
            put("static struct __comp_state *__comp_inst __attribute__((__unused__));\n");
        }
    }

    void forward() {
        for (const Function &function : component_.functions) {
            line("static void __comp_function_{}(struct __comp_state *__comp_inst, long period);",
                 c_name(function.name));
        }
        if (component_.isOn("extra_setup")) {
            put("static int extra_setup(struct __comp_state *__comp_inst, char *prefix, long extra_arg);\n");
        }
        if (component_.isOn("post_export")) {
            put("static int post_export(struct __comp_state *__comp_inst, char *prefix, long extra_arg);\n");
        }
        if (component_.isOn("extra_cleanup")) {
            put("static void extra_cleanup(void);\n");
        }
        if (component_.isOn("count_function")) {
            put("static int get_count(void);\n");
        }
        if (component_.isUserspace()) {
            put("static void user_mainloop(void);\n");
            if (component_.isOn("userinit")) {
                put("static void userinit(int argc, char **argv);\n");
            }
        }
    }

    /// Format of an item's or function's HAL name, and whether it has an element number.
    std::string name_format(std::string_view name) const {
        std::string tail = hal_name(name);
        const std::size_t hash = tail.find('#');
        if (hash != std::string::npos) {
            const std::size_t end = std::min(tail.find_first_not_of('#', hash), tail.size());
            tail = fmt::format("{}%0{}d{}", tail.substr(0, hash), end - hash, tail.substr(end));
        }
        return tail.empty() ? "%s" : "%s." + tail;
    }

    void export_item(const Item &item) {
        source_line(item.place);
        const std::string name = c_name(item.name);
        const std::string indent = item.condition.empty() ? "    " : "        ";
        if (!item.condition.empty()) {
            line("    if ({}) {{", item.condition);
        }
        const std::string maker = fmt::format(
            "hal_{}_{}_newf({}, &(__comp_inst->{}{}), comp_id, \"{}\", prefix{})",
            item.isPin ? "pin" : "param", type_word(item.type), direction_constant(item.direction), name,
            item.array ? "[__comp_i]" : "", name_format(item.name), item.array ? ", __comp_i" : "");
        const std::string value =
            fmt::format("{}__comp_inst->{}{}", item.isPin ? "*" : "", name, item.array ? "[__comp_i]" : "");
        const std::string set =
            item.start_value.empty() || !item.isPin ? "" : fmt::format("{} = {};", value, start_of(item));
        if (item.array) {
            array_loop(item, indent, maker, set);
        } else {
            line("{}__comp_r = {};", indent, maker);
            line("{}if (__comp_r != 0) return __comp_r;", indent);
            if (!set.empty()) {
                line("{}{}", indent, set);
            }
        }
        if (!item.condition.empty()) {
            put("    }\n");
        }
    }

    void array_loop(const Item &item, const std::string &indent, const std::string &maker,
                    const std::string &set) {
        if (!item.array->count.empty()) {
            line("{}__comp_n = ({});", indent, item.array->count);
            line("{}if (__comp_n < 0 || __comp_n > ({})) {{", indent, item.array->size);
            line("{}    rtapi_print_msg(RTAPI_MSG_ERR, \"%s: personality sets %d of {}, 0 to %d are "
                 "possible\\n\", "
                 "prefix, __comp_n, (int)({}));",
                 indent, item.name, item.array->size);
            line("{}    return -EINVAL;\n{}}}", indent, indent);
        } else {
            line("{}__comp_n = ({});", indent, item.array->size);
        }
        line("{}for (__comp_i = 0; __comp_i < __comp_n; __comp_i++) {{", indent);
        line("{}    __comp_r = {};", indent, maker);
        line("{}    if (__comp_r != 0) return __comp_r;", indent);
        if (!set.empty()) {
            line("{}    {}", indent, set);
        }
        line("{}}}", indent);
    }

    static std::string start_of(const Item &item) {
        if (item.type == ValueType::BIT) {
            if (const auto value = parse_switch(item.start_value)) {
                return *value ? "1" : "0";
            }
        }
        return item.start_value;
    }

    /// Start values of data in the instance: set before EXTRA_SETUP, so that it may change them.
    void start_values() {
        for (const Item &item : component_.items) {
            if (item.isPin || item.start_value.empty()) {
                continue;
            }
            source_line(item.place);
            if (item.array) {
                line("    for (__comp_i = 0; __comp_i < ({}); __comp_i++) __comp_inst->{}[__comp_i] = {};",
                     item.array->size, c_name(item.name), start_of(item));
            } else {
                line("    __comp_inst->{} = {};", c_name(item.name), start_of(item));
            }
        }
        for (const Variable &variable : component_.variables) {
            if (!variable.start_value.empty()) {
                source_line(variable.place);
                start_variable(variable);
            }
        }
    }

    void start_variable(const Variable &variable) {
        const bool is_list = variable.start_value.starts_with('{') || variable.start_value.starts_with('"');
        if (is_list) {
            line("    {{ static const __typeof__(__comp_inst->{}) __comp_start = {}; "
                 "__builtin_memcpy(&__comp_inst->{}, &__comp_start, sizeof __comp_start); }}",
                 variable.name, variable.start_value, variable.name);
        } else if (variable.size.empty()) {
            line("    __comp_inst->{} = {};", variable.name, variable.start_value);
        } else {
            const std::string type = plain_type(variable.type) + " " + variable.stars;
            line("    for (__comp_i = 0; __comp_i < (int)(sizeof(__comp_inst->{0}) / sizeof({1})); "
                 "__comp_i++) "
                 "(({1} *)__comp_inst->{0})[__comp_i] = {2};",
                 variable.name, type, variable.start_value);
        }
    }

    void export_function() {
        const bool has_personality = component_.hasPersonality();
        line("\nstatic __attribute__((__unused__)) int export(char *prefix, long extra_arg{}) {{",
             has_personality ? ", long __comp_personality" : "");
        put("    int __comp_r = 0, __comp_i = 0, __comp_n = 0;\n"
            "    struct __comp_state *__comp_inst = hal_malloc(sizeof(struct __comp_state));\n"
            "    (void)__comp_r; (void)__comp_i; (void)__comp_n; (void)prefix; (void)extra_arg;\n"
            "    if (__comp_inst == 0) return -ENOMEM;\n"
            "    __builtin_memset(__comp_inst, 0, sizeof(*__comp_inst));\n");
        if (has_personality) {
            put("    __comp_inst->_personality = (int)__comp_personality;\n");
        }
        start_values();
        if (component_.isOn("extra_setup")) {
            put("    __comp_r = extra_setup(__comp_inst, prefix, extra_arg);\n"
                "    if (__comp_r != 0) return __comp_r;\n");
        }
        own_line();
        if (has_personality) {
            put("#define personality (__comp_inst->_personality)\n");
        }
        for (const Item &item : component_.items) {
            export_item(item);
        }
        if (has_personality) {
            put("#undef personality\n");
        }
        for (const Function &function : component_.functions) {
            source_line(function.place);
            line("    __comp_r = hal_export_functf((void (*)(void *, long))__comp_function_{}, __comp_inst, "
                 "{}, 0, comp_id, "
                 "\"{}\", "
                 "prefix);",
                 c_name(function.name), function.usesFloat ? 1 : 0, name_format(function.name));
            put("    if (__comp_r != 0) return __comp_r;\n");
        }
        own_line();
        put("    if (__comp_last_inst != 0) __comp_last_inst->_next = __comp_inst; else __comp_first_inst = "
            "__comp_inst;\n    __comp_last_inst = __comp_inst;\n");
        if (component_.isOn("post_export")) {
            put("    __comp_r = post_export(__comp_inst, prefix, extra_arg);\n");
        }
        put("    return __comp_r;\n}\n\n");
    }

    void macros() {
        put("\n#define FUNCTION(name) static void __comp_function_##name(struct __comp_state *__comp_inst "
            "__attribute__((__unused__)), "
            "long period __attribute__((__unused__)))\n"
            "#define EXTRA_SETUP() static int extra_setup(struct __comp_state *__comp_inst "
            "__attribute__((__unused__)), "
            "char *prefix __attribute__((__unused__)), long extra_arg __attribute__((__unused__)))\n"
            "#define POST_EXPORT() static int post_export(struct __comp_state *__comp_inst "
            "__attribute__((__unused__)), "
            "char *prefix __attribute__((__unused__)), long extra_arg __attribute__((__unused__)))\n"
            "#define EXTRA_CLEANUP() static void extra_cleanup(void)\n"
            "#define fperiod (period * 1e-9)\n");
        if (component_.isUserspace()) {
            put("#define FOR_ALL_INSTS() for (__comp_inst = __comp_first_inst; __comp_inst != 0; "
                "__comp_inst = __comp_inst->_next)\n");
        }
        for (const Item &item : component_.items) {
            item_macro(item);
        }
        for (const Variable &variable : component_.variables) {
            line("#undef {0}\n#define {0} (__comp_inst->{0})", variable.name);
        }
        if (component_.option("data") != nullptr) {
            put("#undef data\n#define data (__comp_inst->_data)\n");
        }
        if (component_.hasPersonality()) {
            put("#undef personality\n#define personality (__comp_inst->_personality)\n");
        }
    }

    void item_macro(const Item &item) {
        const std::string name = c_name(item.name);
        const std::string index = item.array ? "(i)" : "";
        const std::string place = fmt::format("__comp_inst->{}{}", name, item.array ? "[i]" : "");
        line("#undef {}", name);
        if (!item.isPin) {
            line("#define {}{} ({})", name, index, place);
        } else if (item.direction == Direction::IN && item.type != ValueType::PORT) {
            // Read-only in the component: the compiler reports an assignment with the name of the pin.
            line("#define {}{} (*(const hal_{}_t *)({}))", name, index, type_word(item.type), place);
        } else {
            line("#define {}{} (*({}))", name, index, place);
            item_setter(name, item.array.has_value());
        }
    }

    /// NAME_set(value) or NAME_set(index, value), unless another object of the component has that name.
    void item_setter(const std::string &name, bool is_array) {
        const std::string setter = name + "_set";
        for (const Item &other : component_.items) {
            if (c_name(other.name) == setter) {
                return;
            }
        }
        for (const Variable &variable : component_.variables) {
            if (variable.name == setter) {
                return;
            }
        }
        line("#undef {0}\n#define {0}({1}value) ((void)({2}{3} = (value)))", setter,
             is_array ? "index, " : "", name, is_array ? "(index)" : "");
    }

    void code() {
        const CodeFacts facts = look_at_code(component_.code);
        const bool is_body = !facts.has_function_word && component_.functions.size() == 1;
        put("\n");
        if (is_body) {
            line("FUNCTION({}) {{", c_name(component_.functions.front().name));
        }
        line("#line {} {}", component_.code_line, c_string(component_.file));
        put(component_.code);
        put(is_body ? "\n}\n" : "\n");
    }

    const Component &component_;
    int personalities_;
    std::string prefix_;
    std::string out_;
};

}  // namespace

std::string emit_c(const Component &component, int personalities) {
    return Emitter(component, personalities).run();
}

}  // namespace mw::halcompile
