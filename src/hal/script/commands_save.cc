// SPDX-License-Identifier: GPL-2.0-or-later
// save: the state as HAL commands.
#include <algorithm>

#include <fmt/format.h>

#include "base/atomic_file.hh"
#include "hal/script/commands.hh"

namespace mw::hal::script {

namespace {

enum class Arrows { NO, YES };

/// A value for a setp line: unsigned numbers in hexadecimal.
std::string saved(const Value &value) {
    switch (value.type) {
    case Type::U32: return fmt::format("0x{:08X}", value.as_u32());
    case Type::U64: return fmt::format("0x{:016X}", value.as_u64());
    default: return value.str();
    }
}

std::string save_comp(Instance &hal) {
    std::string text = "# components\n";
    std::vector<CompInfo> components = hal.components().list();
    std::sort(components.begin(), components.end(),
              [](const CompInfo &a, const CompInfo &b) { return a.id < b.id; });
    for (const CompInfo &c : components) {
        if (c.type == CompType::USER) {
            continue;
        }
        if (c.is_loaded_by_loadrt) {
            text += fmt::format("loadrt {}{}{}\n", c.name, c.insmod_args.empty() ? "" : " ", c.insmod_args);
        } else {
            text += fmt::format("#loadrt {}  (not loaded by loadrt, no args saved)\n", c.name);
        }
    }
    return text;
}

std::string save_alias(Instance &hal) {
    std::string text = "# pin aliases\n";
    for (const PinInfo &p : hal.pins().list()) {
        if (!p.original_name.empty()) {
            text += fmt::format("alias pin {} {}\n", p.original_name, p.name);
        }
    }
    text += "# param aliases\n";
    for (const ParamInfo &p : hal.params().list()) {
        if (!p.original_name.empty()) {
            text += fmt::format("alias param {} {}\n", p.original_name, p.name);
        }
    }
    return text;
}

std::string save_signals(Instance &hal, bool onlyUnlinked) {
    std::string text = "# signals\n";
    for (const SignalInfo &s : hal.signals().list()) {
        if (!onlyUnlinked || s.pins.empty()) {
            text += fmt::format("newsig {} {:<5}\n", s.name, type_name(s.type));
        }
    }
    return text;
}

std::string save_sig(Instance &hal) {
    return save_signals(hal, false);
}

std::string save_sigu(Instance &hal) {
    return save_signals(hal, true);
}

std::string links(Instance &hal, Arrows arrows) {
    std::string text = "# links\n";
    for (const PinInfo &p : hal.pins().list()) {
        if (p.signal.empty()) {
            continue;
        }
        const char *arrow = p.dir == Dir::IN ? "<==" : (p.dir == Dir::OUT ? "==>" : "<=>");
        text += fmt::format("linkps {} {} {}\n", p.name, arrows == Arrows::YES ? arrow : "", p.signal);
    }
    return text;
}

std::string save_link(Instance &hal) {
    return links(hal, Arrows::NO);
}

std::string save_linka(Instance &hal) {
    return links(hal, Arrows::YES);
}

/// Pins in the order of a net line: writer, I/O pins, readers.
std::vector<SignalPin> ordered(const SignalInfo &signal) {
    std::vector<SignalPin> pins = signal.pins;
    const auto rank = [](const SignalPin &pin) {
        return pin.dir == Dir::OUT ? 0 : (pin.dir == Dir::IO ? 1 : 2);
    };
    std::stable_sort(pins.begin(), pins.end(),
                     [&](const SignalPin &a, const SignalPin &b) { return rank(a) < rank(b); });
    return pins;
}

std::string single_nets(Instance &hal, Arrows arrows) {
    std::string text = "# nets\n";
    for (const SignalInfo &s : hal.signals().list()) {
        text += fmt::format("newsig {} {:<5}\n", s.name, type_name(s.type));
        for (const SignalPin &pin : s.pins) {
            const char *arrow = pin.dir == Dir::IN ? "==>" : (pin.dir == Dir::OUT ? "<==" : "<=>");
            text += fmt::format("linksp {} {} {}\n", s.name, arrows == Arrows::YES ? arrow : "", pin.name);
        }
    }
    return text;
}

std::string save_net(Instance &hal) {
    return single_nets(hal, Arrows::NO);
}

std::string save_neta(Instance &hal) {
    return single_nets(hal, Arrows::YES);
}

std::string net_lines(Instance &hal, Arrows arrows) {
    std::string text = "# nets\n";
    for (const SignalInfo &s : hal.signals().list()) {
        if (s.pins.empty()) {
            continue;
        }
        text += "net " + s.name;
        const char *between = "";
        for (const SignalPin &pin : arrows == Arrows::YES ? ordered(s) : s.pins) {
            // One arrow between writers and readers.
            const bool is_reader = pin.dir == Dir::IN;
            if (arrows == Arrows::YES && (is_reader || pin.dir == Dir::IO)) {
                text += between;
            }
            text += " " + pin.name;
            between = is_reader ? "" : (pin.dir == Dir::OUT ? " =>" : " <=>");
        }
        text += '\n';
    }
    return text;
}

std::string save_netl(Instance &hal) {
    return net_lines(hal, Arrows::NO);
}

std::string save_netla(Instance &hal) {
    return net_lines(hal, Arrows::YES);
}

std::string save_param(Instance &hal) {
    std::string text = "# parameter values\n";
    for (const ParamInfo &p : hal.params().list()) {
        if (p.dir == Dir::RW) {
            text += fmt::format("setp {} {:>20}\n", p.name, saved(p.value));
        }
    }
    return text;
}

std::string save_thread(Instance &hal) {
    std::string text = "# realtime thread/function links\n";
    std::vector<ThreadInfo> threads = hal.threads().list();
    std::reverse(threads.begin(), threads.end());
    for (const ThreadInfo &t : threads) {
        for (const std::string &function : t.init_functions) {
            text += fmt::format("initf {} {}\n", function, t.name);
        }
        for (const std::string &function : t.functions) {
            text += fmt::format("addf {} {}\n", function, t.name);
        }
    }
    return text;
}

std::string save_unconnected(Instance &hal) {
    std::string text = "# unconnected pin values\n";
    for (const PinInfo &p : hal.pins().list()) {
        if (p.dir == Dir::IN && p.signal.empty()) {
            text += fmt::format("setp {} {:>20}\n", p.name, saved(p.value));
        }
    }
    return text;
}

std::string save_all(Instance &hal) {
    return save_comp(hal) + save_alias(hal) + save_sigu(hal) + save_netla(hal) + save_param(hal) +
           save_thread(hal);
}

std::string save_allu(Instance &hal) {
    return save_comp(hal) + save_alias(hal) + save_sigu(hal) + save_netla(hal) + save_param(hal) +
           save_unconnected(hal) + save_thread(hal);
}

struct SaveKind {
    std::string_view name;
    std::string (*text)(Instance &hal);
};

constexpr SaveKind SAVE_KINDS[] = {
    {"all", save_all},         {"allu", save_allu},     {"comp", save_comp},
    {"alias", save_alias},     {"sig", save_sig},       {"signal", save_sig},
    {"sigu", save_sigu},       {"link", save_link},     {"linka", save_linka},
    {"net", save_net},         {"neta", save_neta},     {"netl", save_netl},
    {"netla", save_netla},     {"netal", save_netla},   {"param", save_param},
    {"parameter", save_param}, {"thread", save_thread}, {"unconnectedinpins", save_unconnected},
};

}  // namespace

Result<> run_save(Session &session, const Call &call) {
    const std::string kind = call.words.empty() ? "all" : call.text(0);
    std::vector<std::string> known;
    for (const SaveKind &save : SAVE_KINDS) {
        if (save.name != kind) {
            known.emplace_back(save.name);
            continue;
        }
        const std::string text = save.text(session.hal());
        if (call.words.size() < 2) {
            session.output().data(text);
            return {};
        }
        if (!session.options().has_files) {
            return fail("files cannot be read here", call.place_of(1));
        }
        const Result<> written = write_file_atomically(call.text(1), text);
        return written ? written : fail(written.error().message, call.place_of(1), written.error().hint);
    }
    return fail(fmt::format("unknown 'save' type '{}'", kind), call.place_of(0), suggestion(kind, known));
}

}  // namespace mw::hal::script
