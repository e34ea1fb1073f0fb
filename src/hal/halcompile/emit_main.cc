// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/halcompile/emit_main.hh"

#include <fmt/core.h>

#include "hal/halcompile/quote.hh"

namespace mw::halcompile {
namespace {

constexpr int MOST_NAMES = 256;

bool isCounted(const Component &component) {
    return !component.isOn("singleton") && !component.isOn("count_function") &&
           component.isOn("rtapi_app", true);
}

bool isText(const ModuleParameter &parameter) {
    return parameter.type == "string" || parameter.type == "char*";
}

bool isLong(const ModuleParameter &parameter) {
    return parameter.type.find("long") != std::string::npos;
}

std::string c_type(const ModuleParameter &parameter) {
    if (isText(parameter)) {
        return "char *";
    }
    return parameter.type == "u32" ? "unsigned " : parameter.type == "s32" ? "int " : parameter.type + " ";
}

/// Returns the declaration of a modparam.
std::string declare(const ModuleParameter &parameter, bool userspace) {
    std::string value = isText(parameter) && !parameter.start_value.empty() ? c_string(parameter.start_value)
                                                                            : parameter.start_value;
    if (!parameter.size.empty() && !value.empty() && !value.starts_with('{')) {
        value = fmt::format("{{ [0 ... ({}) - 1] = {} }}", parameter.size, value);
    }
    std::string out = fmt::format("#line {} {}\nstatic {}{}{}{};\n", parameter.place.line,
                                  c_string(parameter.place.file), c_type(parameter), parameter.name,
                                  parameter.size.empty() ? "" : "[" + parameter.size + "]",
                                  value.empty() ? "" : " = " + value);
    if (!userspace) {
        const char *kind = isText(parameter) ? "STRING" : isLong(parameter) ? "LONG" : "INT";
        out += parameter.size.empty()
                   ? fmt::format("RTAPI_MP_{}({}, {});\n", kind, parameter.name, c_string(parameter.doc))
                   : fmt::format("RTAPI_MP_ARRAY_{}({}, {}, {});\n", kind, parameter.name, parameter.size,
                                 c_string(parameter.doc));
    }
    return out;
}

std::string personality_of_instance(int personalities) {
    return fmt::format(R"(
static __attribute__((__unused__)) int __comp_personality_of(int number) {{
    if (number >= {0})
        rtapi_print_msg(RTAPI_MSG_ERR, "instance %d takes personality %d of {0}: 0x%x\n", number, number % {0},
                        (unsigned)personality[number % {0}]);
    return personality[number % {0}];
}}
)",
                       personalities);
}

}  // namespace

std::string emit_module_parameters(const Component &component, int personalities) {
    std::string out = "\n";
    const bool userspace = component.isUserspace();
    if (isCounted(component)) {
        out += "static int count;\n";
        out += fmt::format("static char *names[{}];\n", MOST_NAMES);
        if (!userspace) {
            out += fmt::format("RTAPI_MP_INT(count, \"number of instances\");\n"
                               "RTAPI_MP_ARRAY_STRING(names, {}, \"names of the instances\");\n",
                               MOST_NAMES);
        }
    }
    if (component.hasPersonality() && component.isOn("rtapi_app", true)) {
        out += fmt::format("static int personality[{}] __attribute__((__unused__));\n", personalities);
        if (!userspace) {
            out += fmt::format("RTAPI_MP_ARRAY_INT(personality, {}, \"personality of each instance\");\n",
                               personalities);
        }
        out += personality_of_instance(personalities);
    }
    for (const ModuleParameter &parameter : component.parameters) {
        if (parameter.type != "dummy") {
            out += declare(parameter, userspace);
        }
    }
    return out;
}

namespace {

/// C code that creates the instances; the variable r has the status.
std::string make_instances(const Component &component, const std::string &prefix) {
    const char *personality = component.hasPersonality() ? ", __comp_personality_of(i)" : "";
    if (component.isOn("singleton")) {
        return fmt::format("    r = export(\"{}\", 0{});\n", prefix, personality);
    }
    const std::string numbered = fmt::format(R"(        for (i = 0; r == 0 && i < made; i++) {{
            char name[HAL_NAME_LEN + 1];
            rtapi_snprintf(name, sizeof(name), "{}.%d", i);
            r = export(name, i{});
        }}
)",
                                             prefix, personality);
    if (component.isOn("count_function")) {
        return fmt::format("    made = get_count();\n    if (made < 0) r = made;\n    {{\n{}    }}\n",
                           numbered);
    }
    std::string default_count = "1";
    if (const Option *option = component.option("default_count")) {
        default_count = option->value;
    }
    return fmt::format(R"(    if (count != 0 && names[0] != 0) {{
        rtapi_print_msg(RTAPI_MSG_ERR, "{0}: give count= or names=, not both\n");
        r = -EINVAL;
    }} else if (count < 0) {{
        rtapi_print_msg(RTAPI_MSG_ERR, "{0}: count=%d is negative\n", count);
        r = -EINVAL;
    }} else if (names[0] != 0) {{
        for (i = 0; r == 0 && i < (int)(sizeof(names) / sizeof(names[0])) && names[i] != 0; i++) {{
            if (names[i][0] == '\0') {{
                rtapi_print_msg(RTAPI_MSG_ERR, "{0}: name %d of names= is empty\n", i + 1);
                r = -EINVAL;
            }} else {{
                r = export(names[i], i{1});
            }}
        }}
    }} else {{
        if (count == 0) count = {2};
        made = count;
{3}    }}
)",
                       component.name, personality, default_count, numbered);
}

}  // namespace

namespace {

bool isConstructable(const Component &component) {
    return isCounted(component) && !component.isUserspace() && component.isOn("constructable", true);
}

/// Creates another instance after the module was loaded; the argument is its personality.
std::string constructor(const Component &component) {
    return fmt::format(R"(
static int __comp_construct(const char *name, const char *arg) {{
    static int made;
    char prefix[HAL_NAME_LEN + 1];
    (void)arg;
    if (rtapi_strlcpy(prefix, name, sizeof(prefix)) >= sizeof(prefix)) return -EINVAL;
    return export(prefix, count + made++{});
}}
)",
                       component.hasPersonality() ? ", simple_strtol(arg, 0, 0)" : "");
}

}  // namespace

std::string emit_app(const Component &component, const std::string &prefix) {
    const std::string linkage = component.isUserspace() ? "static " : "";
    const std::string cleanup = component.isOn("extra_cleanup") ? "        extra_cleanup();\n" : "";
    std::string out = isConstructable(component) ? constructor(component) : std::string();
    out += fmt::format(R"(
{}int rtapi_app_main(void) {{
    int r = 0, i = 0, made = 0;
    (void)i; (void)made;
    comp_id = hal_init("{}");
    if (comp_id < 0) return comp_id;
{}    if (r != 0) {{
        if (r > 0) r = -EINVAL;
{}        hal_exit(comp_id);
        return r;
    }}
{}    hal_ready(comp_id);
    return 0;
}}
)",
                       linkage, component.name, make_instances(component, prefix), cleanup,
                       isConstructable(component) ? "    hal_set_constructor(comp_id, __comp_construct);\n"
                                                  : "");
    out += fmt::format("\n{}void rtapi_app_exit(void) {{\n{}    hal_exit(comp_id);\n}}\n", linkage,
                       component.isOn("extra_cleanup") ? "    extra_cleanup();\n" : "");
    return out;
}

namespace {

/// C code that reads one of our command line arguments.
std::string take_arguments(const Component &component) {
    std::string out = R"(
static __attribute__((__unused__)) int __comp_number(const char *word, const char *text, long *value) {
    char *end = 0;
    *value = strtol(text, &end, 0);
    if (end != text && *end == '\0') return 0;
    fprintf(stderr, "%s is not a number\n", word);
    return -1;
}

static int __comp_argument(char *word) {
    char *value = strchr(word, '=');
    long number = 0;
    (void)number;
    if (value == 0) return 0;
    value++;
)";
    const auto list = [&](const std::string &name, bool of_text, const std::string &size) {
        out += fmt::format(R"(    if (strncmp(word, "{0}=", {1}) == 0) {{
        int i = 0;
        char *rest = 0, *one = strtok_r(value, ",", &rest);
        for (; one != 0; one = strtok_r(0, ",", &rest)) {{
            if (i == ({2})) {{
                fprintf(stderr, "{0}= takes at most %d values\n", (int)({2}));
                return -1;
            }}
            {3}
        }}
        return 1;
    }}
)",
                           name, name.size() + 1, size,
                           of_text ? fmt::format("{}[i++] = one;", name)
                                   : fmt::format("if (__comp_number(\"{0}=\", one, &number) < 0) return -1; "
                                                 "{0}[i++] = number;",
                                                 name));
    };
    const auto scalar = [&](const std::string &name, bool of_text) {
        out += fmt::format(
            "    if (strncmp(word, \"{0}=\", {1}) == 0) {{\n        {2}\n        return 1;\n    }}\n", name,
            name.size() + 1,
            of_text
                ? fmt::format("{} = value;", name)
                : fmt::format("if (__comp_number(word, value, &number) < 0) return -1; {} = number;", name));
    };
    if (isCounted(component)) {
        scalar("count", false);
        list("names", true, std::to_string(MOST_NAMES));
    }
    if (component.hasPersonality() && component.isOn("rtapi_app", true)) {
        list("personality", false, "(int)(sizeof(personality) / sizeof(personality[0]))");
    }
    for (const ModuleParameter &parameter : component.parameters) {
        if (parameter.type == "dummy") {
            continue;
        }
        if (parameter.size.empty()) {
            scalar(parameter.name, isText(parameter));
        } else {
            list(parameter.name, isText(parameter), parameter.size);
        }
    }
    return out + "    return 0;\n}\n";
}

}  // namespace

std::string emit_main(const Component &component) {
    const bool has_app = component.isOn("rtapi_app", true);
    std::string out = has_app ? std::string() : "int rtapi_app_main(void);\nvoid rtapi_app_exit(void);\n";
    out += take_arguments(component);
    const std::string leftover =
        component.isOn("userinit")
            ? "    userinit(kept, argv);\n"
            : fmt::format(
                  "    for (i = 1; i < kept; i++) fprintf(stderr, \"{}: '%s' means nothing here\\n\", "
                  "argv[i]);\n",
                  component.name);
    // Checked before any code of the program runs.
    const std::string refusal =
        isCounted(component)
            ? fmt::format(
                  "    if (count != 0 && names[0] != 0) {{\n        fprintf(stderr, \"{}: give count= or "
                  "names=, not both\\n\");\n        return 1;\n    }}\n",
                  component.name)
            : "";
    out += fmt::format(R"(
int main(int argc, char **argv) {{
    int i, kept = 1;
    for (i = 1; i < argc; i++) {{
        int taken = __comp_argument(argv[i]);
        if (taken < 0) return 1;
        if (taken == 0) argv[kept++] = argv[i];
    }}
    if (argc > 0) argv[kept] = 0;
{}{}    if (rtapi_app_main() < 0) return 1;
    user_mainloop();
    rtapi_app_exit();
    return 0;
}}
)",
                       refusal, leftover);
    return out;
}

}  // namespace mw::halcompile
