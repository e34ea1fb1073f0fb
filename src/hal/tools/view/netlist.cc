// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/tools/view/netlist.hh"

#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <map>
#include <vector>

#include <fmt/format.h>

#include "base/atomic_file.hh"

namespace mw::hal::view {

namespace {

struct Box {
    std::string component;
    std::vector<PinInfo> inputs, outputs;
};

/// "and2.0.in0" -> "and2.0"; a name without a dot belongs to its component.
std::string instance_of(const PinInfo &pin) {
    const std::string &name = pin.original_name.empty() ? pin.name : pin.original_name;
    const std::size_t dot = name.rfind('.');
    return dot == std::string::npos ? pin.owner : name.substr(0, dot);
}

std::string short_name(const PinInfo &pin) {
    const std::size_t dot = pin.name.rfind('.');
    return dot == std::string::npos ? pin.name : pin.name.substr(dot + 1);
}

std::string quoted(const std::string &text) {
    std::string out = "\"";
    for (const char c : text) {
        out += c == '"' || c == '\\' ? std::string{'\\', c} : std::string{c};
    }
    return out + "\"";
}

std::string html(const std::string &text) {
    std::string out;
    for (const char c : text) {
        switch (c) {
        case '<': out += "&lt;"; break;
        case '>': out += "&gt;"; break;
        case '&': out += "&amp;"; break;
        case '"': out += "&quot;"; break;
        default: out += c;
        }
    }
    return out;
}

std::string cell(const PinInfo *pin, const char *align) {
    if (pin == nullptr) {
        return "<TD BORDER=\"0\"></TD>";
    }
    return fmt::format("<TD PORT=\"{}\" ALIGN=\"{}\">{}</TD>", html(pin->name), align,
                       html(short_name(*pin)));
}

std::string box_text(const std::string &name, const Box &box) {
    std::string text =
        fmt::format("  {} [label=<<TABLE BORDER=\"1\" CELLBORDER=\"0\" CELLSPACING=\"0\" CELLPADDING=\"3\">\n"
                    "    <TR><TD COLSPAN=\"2\" BGCOLOR=\"#dce6f2\"><B>{}</B></TD></TR>\n",
                    quoted(name), html(name));
    for (std::size_t row = 0; row < std::max(box.inputs.size(), box.outputs.size()); ++row) {
        text += "    <TR>" + cell(row < box.inputs.size() ? &box.inputs[row] : nullptr, "LEFT") +
                cell(row < box.outputs.size() ? &box.outputs[row] : nullptr, "RIGHT") + "</TR>\n";
    }
    return text + "    </TABLE>>];\n";
}

std::string port(const std::map<std::string, std::string> &instance_by_pin, const std::string &pin) {
    return quoted(instance_by_pin.at(pin)) + ":" + quoted(pin);
}

std::string signal_text(const SignalInfo &signal, const std::map<std::string, std::string> &instance_by_pin,
                        bool showsValues) {
    const std::string label =
        showsValues ? fmt::format("{} = {}", signal.name, signal.value.str()) : signal.name;
    std::vector<std::string> sources, readers, both;
    for (const SignalPin &pin : signal.pins) {
        if (instance_by_pin.contains(pin.name)) {
            (pin.dir == Dir::OUT ? sources : pin.dir == Dir::IN ? readers : both).push_back(pin.name);
        }
    }
    if (sources.empty() && readers.empty() && both.empty()) {
        return "";
    }
    const char *color = signal.type == Type::BIT     ? "#a04000"
                        : signal.type == Type::FLOAT ? "#1f4e9c"
                                                     : "#2e7d32";
    std::string text;
    if (sources.size() == 1 && both.empty()) {
        for (const std::string &reader : readers) {
            text += fmt::format("  {} -> {} [label={}, color=\"{}\", fontcolor=\"{}\"];\n",
                                port(instance_by_pin, sources[0]), port(instance_by_pin, reader),
                                quoted(label), color, color);
        }
        if (!readers.empty()) {
            return text;
        }
    }
    const std::string node = quoted("signal " + signal.name);
    text += fmt::format("  {} [shape=ellipse, label={}, color=\"{}\"];\n", node, quoted(label), color);
    for (const std::string &source : sources) {
        text += fmt::format("  {} -> {} [color=\"{}\"];\n", port(instance_by_pin, source), node, color);
    }
    for (const std::string &reader : readers) {
        text += fmt::format("  {} -> {} [color=\"{}\"];\n", node, port(instance_by_pin, reader), color);
    }
    for (const std::string &pin : both) {
        text +=
            fmt::format("  {} -> {} [dir=both, color=\"{}\"];\n", node, port(instance_by_pin, pin), color);
    }
    return text;
}

/// Runs dot with the text as its input in memory, so that nothing can block and no other file is written.
Result<> run_dot(const std::string &text, const std::string &format, const std::string &path) {
    const int input = ::memfd_create("netlist", MFD_CLOEXEC);
    const bool is_written = input >= 0 &&
                            ::write(input, text.data(), text.size()) == static_cast<ssize_t>(text.size()) &&
                            ::lseek(input, 0, SEEK_SET) == 0;
    int error = is_written ? 0 : errno;
    pid_t pid = 0;
    if (is_written) {
        posix_spawn_file_actions_t actions;
        ::posix_spawn_file_actions_init(&actions);
        ::posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
        std::string option = "-T" + format, out = "-o" + path, program = "dot";
        char *const argv[] = {program.data(), option.data(), out.data(), nullptr};
        error = ::posix_spawnp(&pid, "dot", &actions, nullptr, argv, environ);
        ::posix_spawn_file_actions_destroy(&actions);
    }
    if (input >= 0) {
        ::close(input);
    }
    if (error != 0 || !is_written) {
        return fail(fmt::format("cannot run Graphviz' program dot: {}", std::strerror(error)), {},
                    "install the package graphviz, or write a .dot file");
    }
    int status = 0;
    while (::waitpid(pid, &status, 0) < 0 && errno == EINTR) {
    }
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
        return fail(fmt::format("dot could not write '{}'", path));
    }
    return {};
}

}  // namespace

std::string netlist_dot(Instance &hal, const NetlistOptions &options) {
    std::map<std::string, Box> boxes;
    std::map<std::string, std::string> instance_by_pin;
    std::map<std::string, bool> isWanted;
    for (const PinInfo &pin : hal.pins().list(options.glob == "*" ? "*" : options.glob + ".*")) {
        isWanted[instance_of(pin)] = true;
        if (!pin.signal.empty()) {
            isWanted["\n" + pin.signal] = true;
        }
    }
    for (const PinInfo &pin : hal.pins().list()) {
        const std::string instance = instance_of(pin);
        const bool shown = isWanted.contains(instance) ? !pin.signal.empty() || options.showsUnlinked
                                                       : isWanted.contains("\n" + pin.signal);
        if (shown) {
            Box &box = boxes[instance];
            (pin.dir == Dir::OUT ? box.outputs : box.inputs).push_back(pin);
            instance_by_pin[pin.name] = instance;
        }
    }
    std::string text =
        "digraph hal {\n  rankdir=LR;\n  node [shape=plaintext, fontname=\"sans-serif\", fontsize=10];\n"
        "  edge [fontname=\"sans-serif\", fontsize=9];\n";
    for (const auto &[name, box] : boxes) {
        text += box_text(name, box);
    }
    for (const SignalInfo &signal : hal.signals().list()) {
        text += signal_text(signal, instance_by_pin, options.showsValues);
    }
    return text + "}\n";
}

Result<> write_netlist(Instance &hal, const NetlistOptions &options, const std::string &path) {
    const std::size_t dot = path.rfind('.');
    const std::string ending = dot == std::string::npos ? "" : path.substr(dot + 1);
    const std::string text = netlist_dot(hal, options);
    if (ending == "dot") {
        return write_file_atomically(path, text);
    }
    if (ending != "svg" && ending != "png" && ending != "pdf") {
        return fail(fmt::format("a drawing is a .svg, .png, .pdf or .dot file, not '{}'", path));
    }
    return run_dot(text, ending, path);
}

}  // namespace mw::hal::view
