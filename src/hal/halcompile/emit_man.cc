// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/halcompile/emit_man.hh"

#include <fmt/core.h>

#include "base/text.hh"

namespace mw::halcompile {
namespace {

/// Escapes plain text for troff: dashes and backslashes are printed, and no line becomes a request.
std::string plain(std::string_view text) {
    std::string out;
    for (const char c : text) {
        if (c == '\\') {
            out += "\\e";
        } else if (c == '-') {
            out += "\\-";
        } else if ((c == '.' || c == '\'') && (out.empty() || out.back() == '\n')) {
            out += "\\&";
            out += c;
        } else {
            out += c;
        }
    }
    return out;
}

/// The index of an array's last element, with as many digits as the name has hash marks.
std::string last_index(const ArraySize &array, std::size_t digits) {
    const auto size = parse_int(array.size);
    return size ? fmt::format("{:0{}}", *size - 1, digits) : fmt::format("{}-1", array.size);
}

class Page {
  public:
    explicit Page(const Component &component) : component_(component) {
        instance_ = hal_prefix(component) + (component.isOn("singleton") ? "" : ".N");
    }

    std::string run() {
        const std::string name = component_.name;
        line(".\\\" Made by halcompile from {}.comp", name);
        line(".TH {} {} \"\" \"Millwright\" \"HAL component\"", to_upper(name), man_section(component_));
        section("NAME");
        const std::string_view doc = component_.doc;
        const std::size_t first_end = doc.find('\n');
        line("{} \\- {}", plain(name), doc.empty() ? "HAL component" : doc.substr(0, first_end));
        synopsis();
        if (first_end != std::string_view::npos || component_.description) {
            section("DESCRIPTION");
            if (first_end != std::string_view::npos) {
                line("{}\n.PP", trim(doc.substr(first_end)));
            }
            text(component_.description);
        }
        functions();
        items("PINS", true);
        items("PARAMETERS", false);
        paragraph("EXAMPLES", component_.examples);
        paragraph("NOTES", component_.notes);
        paragraph("SEE ALSO", component_.see_also);
        if (!component_.authors.empty()) {
            section("AUTHOR");
            for (const Text &author : component_.authors) {
                line("{}\n.br", author.text);
            }
        }
        paragraph("LICENSE", component_.license);
        return std::move(out_);
    }

  private:
    template <class... Args>
    void line(fmt::format_string<Args...> text, Args &&...args) {
        out_ += fmt::format(text, std::forward<Args>(args)...);
        out_ += '\n';
    }
    void section(const char *title) { line(".SH {}", title); }
    void text(const std::optional<Text> &paragraph) {
        if (paragraph) {
            line("{}", trim(paragraph->text));
        }
    }
    void paragraph(const char *title, const std::optional<Text> &body) {
        if (body) {
            section(title);
            text(body);
        }
    }

    void synopsis() {
        section("SYNOPSIS");
        const std::string name = plain(component_.name);
        if (component_.isOn("homemod")) {
            line("Homing module, named in the INI file by\n.B [EMCMOT]HOMEMOD={}", name);
            return;
        }
        if (component_.isOn("tpmod")) {
            line("Trajectory planner module, named in the INI file by\n.B [TRAJ]TPMOD={}", name);
            return;
        }
        std::string words;
        const bool counted = !component_.isOn("singleton") && !component_.isOn("count_function");
        if (counted && component_.isOn("rtapi_app", true)) {
            words += " [count=\\fIN\\fB | names=\\fIname1\\fB[,\\fIname2\\fB...]]";
        }
        if (component_.hasPersonality()) {
            words += " [personality=\\fIP1\\fB[,\\fIP2\\fB...]]";
        }
        for (const ModuleParameter &parameter : component_.parameters) {
            const std::string shown = plain(parameter.name);
            words += parameter.size.empty() ? fmt::format(" [{}=\\fIvalue\\fB]", shown)
                                            : fmt::format(" [{}=\\fIvalue1\\fB[,\\fIvalue2\\fB...]]", shown);
        }
        line(".B {} {}{}", component_.isUserspace() ? "loadusr \\-W" : "loadrt", name, words);
        for (const ModuleParameter &parameter : component_.parameters) {
            line(".TP\n.BI {} = value\n{}", plain(parameter.name), trim(parameter.doc));
            if (!parameter.start_value.empty()) {
                line("(default: {})", plain(parameter.start_value));
            }
        }
    }

    std::string full_name(std::string_view name) const {
        const std::string tail = hal_name(name);
        return plain(tail.empty() ? instance_ : instance_ + '.' + tail);
    }

    void functions() {
        if (component_.functions.empty()) {
            return;
        }
        section("FUNCTIONS");
        for (const Function &function : component_.functions) {
            line(".TP\n.B {}\n{}", full_name(function.name),
                 function.doc.empty() ? "\\&" : trim(function.doc));
        }
    }

    void items(const char *title, bool is_pin) {
        bool first = true;
        for (const Item &item : component_.items) {
            if (item.isPin != is_pin) {
                continue;
            }
            if (first) {
                section(title);
                first = false;
            }
            show(item);
        }
    }

    void show(const Item &item) {
        std::string name = full_name(item.name);
        std::string range;
        if (item.array && name.find('#') != std::string::npos) {
            const std::size_t hash = name.find('#');
            const std::size_t digits = name.find_last_of('#') + 1 - hash;
            name.replace(hash, digits, std::string(digits, 'M'));
            range = fmt::format(" (\\fI{}\\fR = {:0{}} to {})", std::string(digits, 'M'), 0, digits,
                                last_index(*item.array, digits));
            if (!item.array->count.empty()) {
                range += fmt::format(", the first {} of them", plain(item.array->count));
            }
        }
        line(".TP\n\\fB{}\\fR {} {}{}{}{}", name, type_word(item.type), direction_word(item.direction), range,
             item.condition.empty() ? "" : fmt::format(" [if {}]", plain(item.condition)),
             item.start_value.empty() ? "" : fmt::format(" (default: \\fI{}\\fR)", plain(item.start_value)));
        line("{}", item.doc.empty() ? "\\&" : trim(item.doc));
    }

    const Component &component_;
    std::string instance_;
    std::string out_;
};

}  // namespace

std::string emit_man(const Component &component) {
    return Page(component).run();
}

int man_section(const Component &component) {
    return component.isUserspace() ? 1 : 9;
}

}  // namespace mw::halcompile
