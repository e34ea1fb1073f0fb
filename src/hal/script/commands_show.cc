// SPDX-License-Identifier: GPL-2.0-or-later
// show and list. The columns are those that scripts of existing installations parse.
#include <fnmatch.h>

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "base/text.hh"
#include "hal/script/commands.hh"

namespace mw::hal::script {

namespace {

/// Filter of a listing: one type, and names that match one of the patterns (all names without patterns).
struct Patterns {
    std::optional<Type> type;
    std::vector<std::string> globs;

    /// A pattern matches a whole name, or its beginning.
    bool isMatch(const std::string &name) const {
        return globs.empty() || std::any_of(globs.begin(), globs.end(), [&](const std::string &glob) {
                   return name.starts_with(glob) || fnmatch(glob.c_str(), name.c_str(), 0) == 0;
               });
    }
};

/// A value in show's format: unsigned numbers in hexadecimal.
std::string shown(const Value &value) {
    switch (value.type) {
    case Type::U32: return fmt::format("0x{:08X}", value.as_u32());
    case Type::U64: return fmt::format("0x{:016X}", value.as_u64());
    default: return value.str();
    }
}

/// The matching items, in order.
template <class Item>
std::vector<Item> matching(const Patterns &patterns, std::vector<Item> items) {
    std::erase_if(items, [&](const Item &item) {
        if constexpr (requires { item.type == *patterns.type; }) {
            if (patterns.type && item.type != *patterns.type) {
                return true;
            }
        }
        return !patterns.isMatch(item.name);
    });
    return items;
}

std::vector<PinInfo> pins(Instance &hal, const Patterns &patterns) {
    return matching(patterns, hal.pins().list());
}
std::vector<ParamInfo> params(Instance &hal, const Patterns &patterns) {
    return matching(patterns, hal.params().list());
}
std::vector<SignalInfo> signals(Instance &hal, const Patterns &patterns) {
    return matching(patterns, hal.signals().list());
}
std::vector<FunctionInfo> functs(Instance &hal, const Patterns &patterns) {
    return matching(patterns, hal.functions().list());
}
/// Slowest first.
std::vector<ThreadInfo> threads(Instance &hal, const Patterns &patterns) {
    auto items = matching(patterns, hal.threads().list());
    std::reverse(items.begin(), items.end());
    return items;
}
/// Newest first.
std::vector<CompInfo> components(Instance &hal, const Patterns &patterns) {
    auto items = matching(patterns, hal.components().list());
    std::sort(items.begin(), items.end(), [](const CompInfo &a, const CompInfo &b) { return a.id > b.id; });
    return items;
}

const char *type_word(CompType type) {
    // Pseudo components of threads count as realtime components.
    return type == CompType::USER ? "User" : "RT";
}

std::string show_comp(Session &session, const Patterns &patterns) {
    std::string text;
    if (!session.options().is_script) {
        text += "Loaded HAL Components:\n";
        text += "ID      Type  Name                                            PID   State\n";
    }
    for (const CompInfo &c : components(session.hal(), patterns)) {
        const std::string pid = c.type == CompType::USER ? fmt::format("{}", c.pid) : "";
        text += fmt::format("{:>6}  {:<4}  {:<47}{:>6} {}\n", c.id, type_word(c.type), c.name, pid,
                            c.isReady ? "ready" : "initializing");
    }
    return text + "\n";
}

std::string arrow_to(const PinInfo &pin) {
    const char *arrow = pin.dir == Dir::IN ? "<==" : (pin.dir == Dir::OUT ? "==>" : "<=>");
    return pin.signal.empty() ? "" : fmt::format(" {} {}", arrow, pin.signal);
}

std::string show_pin(Session &session, const Patterns &patterns) {
    const bool is_script = session.options().is_script;
    std::string text;
    if (!is_script) {
        text += "Component Pins:\n";
        text += "Owner   Type  Dir                 Value  Name\n";
    }
    for (const PinInfo &p : pins(session.hal(), patterns)) {
        if (is_script) {
            text += fmt::format("{} {:<5} {} {} {}{}\n", p.owner, type_name(p.type), dir_name(p.dir),
                                p.value.str(), p.name, arrow_to(p));
        } else {
            text += fmt::format("{:>6}  {:<5} {:<3} {:>21}  {}{}\n", p.owner_id, type_name(p.type),
                                dir_name(p.dir), shown(p.value), p.name, arrow_to(p));
        }
    }
    return text + "\n";
}

std::string show_param(Session &session, const Patterns &patterns) {
    const bool is_script = session.options().is_script;
    std::string text;
    if (!is_script) {
        text += "Parameters:\n";
        text += "Owner   Type  Dir                 Value  Name\n";
    }
    for (const ParamInfo &p : params(session.hal(), patterns)) {
        if (is_script) {
            text += fmt::format("{} {:<5} {} {} {}\n", p.owner, type_name(p.type), dir_name(p.dir),
                                p.value.str(), p.name);
        } else {
            text += fmt::format("{:>6}  {:<5} {:<3} {:>21}  {}\n", p.owner_id, type_name(p.type),
                                dir_name(p.dir), shown(p.value), p.name);
        }
    }
    return text + "\n";
}

const char *arrow_of(Dir dir) {
    return dir == Dir::IN ? "==>" : (dir == Dir::OUT ? "<==" : "<=>");
}

std::string show_sig(Session &session, const Patterns &patterns) {
    const bool is_script = session.options().is_script;
    std::string text;
    if (!is_script) {
        text += "Signals:\n";
        text += "Type                  Value  Name     (linked to)\n";
    }
    for (const SignalInfo &s : signals(session.hal(), patterns)) {
        if (is_script) {
            text += fmt::format("{:<5}  {}  {}", type_name(s.type), s.value.str(), s.name);
            for (const SignalPin &pin : s.pins) {
                text += fmt::format(" {} {}", arrow_of(pin.dir), pin.name);
            }
            text += '\n';
            continue;
        }
        text += fmt::format("{:<5} {:>21}  {}\n", type_name(s.type), shown(s.value), s.name);
        for (const SignalPin &pin : s.pins) {
            text += fmt::format("{:33}{} {}\n", "", arrow_of(pin.dir), pin.name);
        }
    }
    return text + "\n";
}

std::string show_funct(Session &session, const Patterns &patterns) {
    const bool is_script = session.options().is_script;
    std::string text;
    if (!is_script) {
        text += "Exported Functions:\n";
        text += "Owner   CodeAddr  Arg       FP   Users  Name\n";
    }
    for (const FunctionInfo &f : functs(session.hal(), patterns)) {
        const char *fp = f.usesFloat ? "YES" : "NO";
        if (is_script) {
            text += fmt::format("{} {:012x} {:012x} {:<3} {:>2} {}\n", f.owner, f.address, f.argument, fp,
                                f.users, f.name);
        } else {
            text += fmt::format(" {:05}  {:012x}  {:012x}  {:<3} {:>6}   {}\n", f.owner_id, f.address,
                                f.argument, fp, f.users, f.name);
        }
    }
    return text + "\n";
}

std::string show_thread(Session &session, const Patterns &patterns) {
    const bool is_script = session.options().is_script;
    std::string text;
    if (!is_script) {
        text += "Realtime Threads:\n";
        text += "     Period  FP     Name               (     Time, Max-Time )\n";
    }
    for (const ThreadInfo &t : threads(session.hal(), patterns)) {
        if (is_script) {
            text += fmt::format("{} YES {} {:>8} {}", t.period_ns, t.name, t.time_ns, t.tmax_ns);
            for (const std::string &function : t.functions) {
                text += " " + function;
            }
            text += '\n';
            continue;
        }
        text +=
            fmt::format("{:>11}  YES  {:>20} ( {:>8}, {:>8} )\n", t.period_ns, t.name, t.time_ns, t.tmax_ns);
        int number = 1;
        for (const std::string &function : t.init_functions) {
            text += fmt::format("               once {}\n", function);
        }
        for (const std::string &function : t.functions) {
            text += fmt::format("                 {:>2} {}\n", number++, function);
        }
    }
    return text + "\n";
}

template <class Item>
std::string alias_block(Session &session, const char *title, const std::vector<Item> &items) {
    const bool is_script = session.options().is_script;
    std::string text;
    if (!is_script) {
        text += fmt::format("{}:\n {:<48} {}\n", title, "Alias", "Original Name");
    }
    for (const Item &item : items) {
        if (item.original_name.empty()) {
            continue;
        }
        text += is_script ? fmt::format(" {}  {}\n", item.name, item.original_name)
                          : fmt::format(" {:<48} {}\n", item.name, item.original_name);
    }
    return text + "\n";
}

std::string show_pin_alias(Session &session, const Patterns &patterns) {
    return alias_block(session, "Pin Aliases", pins(session.hal(), patterns));
}

std::string show_param_alias(Session &session, const Patterns &patterns) {
    return alias_block(session, "Parameter Aliases", params(session.hal(), patterns));
}

std::string show_alias(Session &session, const Patterns &patterns) {
    return show_pin_alias(session, patterns) + show_param_alias(session, patterns);
}

std::string show_all(Session &session, const Patterns &patterns) {
    return show_comp(session, patterns) + show_pin(session, patterns) + show_pin_alias(session, patterns) +
           show_sig(session, patterns) + show_param(session, patterns) + show_param_alias(session, patterns) +
           show_funct(session, patterns) + show_thread(session, patterns);
}

struct ShowKind {
    std::string_view name;
    std::string (*text)(Session &session, const Patterns &patterns);
};

constexpr ShowKind SHOW_KINDS[] = {
    {"all", show_all},        {"comp", show_comp},     {"pin", show_pin},         {"sig", show_sig},
    {"signal", show_sig},     {"param", show_param},   {"parameter", show_param}, {"funct", show_funct},
    {"function", show_funct}, {"thread", show_thread}, {"alias", show_alias},
};

template <class Item>
std::string names_of(const std::vector<Item> &items) {
    std::string text;
    for (const Item &item : items) {
        text += item.name + ' ';
    }
    return text + '\n';
}

/// The names that list prints; nothing for an unknown type.
std::optional<std::string> list_text(Instance &hal, const std::string &kind, const Patterns &patterns) {
    if (kind == "pin") {
        return names_of(pins(hal, patterns));
    }
    if (kind == "param" || kind == "parameter") {
        return names_of(params(hal, patterns));
    }
    if (kind == "sig" || kind == "signal") {
        return names_of(signals(hal, patterns));
    }
    if (kind == "comp") {
        return names_of(components(hal, patterns));
    }
    if (kind == "funct" || kind == "function") {
        return names_of(functs(hal, patterns));
    }
    if (kind == "thread") {
        return names_of(threads(hal, patterns));
    }
    return std::nullopt;
}

/// Words from 1 on: optionally -tTYPE, then patterns.
Result<Patterns> parse_patterns(const Call &call) {
    Patterns patterns;
    for (std::size_t i = 1; i < call.words.size(); ++i) {
        if (i > 1 || !call.text(i).starts_with("-t")) {
            patterns.globs.push_back(call.text(i));
            continue;
        }
        const Result<Type> type = parse_type(std::string_view(call.text(i)).substr(2));
        if (!type) {
            return fail(type.error().message, call.place_of(i), "-tbit, for example");
        }
        patterns.type = *type;
    }
    return patterns;
}

}  // namespace

Result<> run_show(Session &session, const Call &call) {
    const std::string kind = call.words.empty() ? "all" : call.text(0);
    const Result<Patterns> patterns = parse_patterns(call);
    if (!patterns) {
        return std::unexpected(patterns.error());
    }
    std::vector<std::string> known;
    for (const ShowKind &show : SHOW_KINDS) {
        if (show.name == kind) {
            session.output().data(show.text(session, *patterns));
            return {};
        }
        known.emplace_back(show.name);
    }
    return fail(fmt::format("unknown 'show' type '{}'", kind), call.place_of(0), suggestion(kind, known));
}

Result<> run_list(Session &session, const Call &call) {
    const Result<Patterns> patterns = parse_patterns(call);
    if (!patterns) {
        return std::unexpected(patterns.error());
    }
    const std::optional<std::string> text = list_text(session.hal(), call.text(0), *patterns);
    if (!text) {
        return fail(fmt::format("unknown 'list' type '{}'", call.text(0)), call.place_of(0),
                    suggestion(call.text(0), {"comp", "pin", "sig", "param", "funct", "thread"}));
    }
    session.output().data(*text);
    return {};
}

}  // namespace mw::hal::script
