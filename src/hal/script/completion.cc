// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/script/completion.hh"

#include <algorithm>
#include <filesystem>
#include <span>

#include "base/text.hh"
#include "hal/core/loader.hh"
#include "hal/script/commands.hh"

namespace mw::hal::script {

namespace {

using Words = std::vector<std::string>;

/// A position in a command line: the words before it, and the start of the current one.
struct Place {
    Session &session;
    Words words;  ///< words of the command so far, including its name, without arrows
    std::string start;

    Instance &hal() const { return session.hal(); }
};

using Candidates = Words (*)(const Place &place);

Words add(Words words, const Words &more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

template <class Items>
Words names(const Items &items) {
    Words words;
    for (const auto &item : items) {
        words.push_back(item.name);
    }
    return words;
}

Words any_pins(const Place &place) {
    return names(place.hal().pins().list());
}
Words any_params(const Place &place) {
    return names(place.hal().params().list());
}
Words values(const Place &place) {
    return add(any_params(place), any_pins(place));
}
Words signals(const Place &place) {
    return names(place.hal().signals().list());
}
Words functs(const Place &place) {
    return names(place.hal().functions().list());
}
Words threads(const Place &place) {
    return names(place.hal().threads().list());
}
Words components(const Place &place) {
    return names(place.hal().components().list());
}

/// Parameters and pins that setp accepts.
Words settable(const Place &place) {
    Words words;
    for (const ParamInfo &param : place.hal().params().list()) {
        if (param.dir == Dir::RW) {
            words.push_back(param.name);
        }
    }
    for (const PinInfo &pin : place.hal().pins().list()) {
        if (pin.dir != Dir::OUT && pin.signal.empty()) {
            words.push_back(pin.name);
        }
    }
    return words;
}

/// Pins that can be linked: of the type of the signal, or of the first pin.
Words pins_to_link(const Place &place) {
    std::optional<Type> type;
    if (place.words.size() > 1 && place.hal().signals().has(place.words[1])) {
        type = place.hal().signals().find(place.words[1])->type;
    }
    for (std::size_t i = 1; !type && i < place.words.size(); ++i) {
        if (place.hal().pins().has(place.words[i])) {
            type = place.hal().pins().find(place.words[i])->type;
        }
    }
    Words words;
    for (const PinInfo &pin : place.hal().pins().list()) {
        if (pin.signal.empty() && (!type || pin.type == *type)) {
            words.push_back(pin.name);
        }
    }
    return words;
}

Words linked_pins(const Place &place) {
    Words words;
    for (const PinInfo &pin : place.hal().pins().list()) {
        if (!pin.signal.empty()) {
            words.push_back(pin.name);
        }
    }
    return words;
}

Words programs(const Place &place) {
    Words words = {"all"};
    for (const CompInfo &component : place.hal().components().list()) {
        if (component.type == CompType::USER) {
            words.push_back(component.name);
        }
    }
    return words;
}

Words loaded_modules(const Place &place) {
    const auto modules = place.session.host().modules();
    return add({"all"}, modules ? *modules : Words{});
}

Words loaded(const Place &place) {
    return add(loaded_modules(place), programs(place));
}

Words modules(const Place &) {
    constexpr std::string_view ENDING = ".so";
    Words words;
    for (const std::string &folder : Loader::default_folders()) {
        std::error_code ignored;
        for (const auto &entry : std::filesystem::directory_iterator(folder, ignored)) {
            const std::string name = entry.path().filename().string();
            if (name.ends_with(ENDING) && !name.starts_with("lib")) {
                words.push_back(name.substr(0, name.size() - ENDING.size()));
            }
        }
    }
    return words;
}

Words module_parameters(const Place &) {
    return {"count=", "names=", "personality="};
}

/// Files and folders that begin with the typed text.
Words files(const Place &place) {
    const std::size_t slash = place.start.rfind('/');
    const std::string folder = slash == std::string::npos ? "" : place.start.substr(0, slash + 1);
    Words words;
    std::error_code ignored;
    for (const auto &entry : std::filesystem::directory_iterator(folder.empty() ? "." : folder, ignored)) {
        const std::string name = entry.path().filename().string();
        const bool hidden = name.starts_with('.');
        if (!hidden) {
            words.push_back(folder + name + (entry.is_directory(ignored) ? "/" : ""));
        }
    }
    return words;
}

Words sources(const Place &place) {
    Words words = files(place);
    std::erase_if(words, [](const std::string &word) {
        return !word.ends_with('/') && !word.ends_with(".hal") && !word.ends_with(".tcl");
    });
    for (const std::string &folder : place.session.options().library) {
        std::error_code ignored;
        for (const auto &entry : std::filesystem::directory_iterator(folder, ignored)) {
            words.push_back("LIB:" + entry.path().filename().string());
        }
    }
    return words;
}

/// Options, then programs.
Words program(const Place &place) {
    if (place.words.back() == "-Wn") {
        return {};
    }
    return add({"-W", "-Wn", "-i", "-w"}, files(place));
}

Words types(const Place &) {
    return {"bit", "float", "port", "s32", "s64", "u32", "u64"};
}
Words lock_kinds(const Place &) {
    return {"all", "none", "tune"};
}
Words unlock_kinds(const Place &) {
    return {"all", "tune"};
}
Words status_kinds(const Place &) {
    return {"all", "lock", "mem"};
}
Words levels(const Place &) {
    return {"0", "1", "2", "3", "4", "5"};
}
Words pin_or_param(const Place &) {
    return {"param", "pin"};
}
Words show_kinds(const Place &) {
    return {"alias", "all", "comp", "funct", "param", "pin", "sig", "thread"};
}
Words list_kinds(const Place &) {
    return {"comp", "funct", "param", "pin", "sig", "thread"};
}
Words save_kinds(const Place &) {
    return {"alias", "all", "allu", "comp",   "link",
            "linka", "net", "neta", "netl",   "netla",
            "param", "sig", "sigu", "thread", "unconnectedinpins"};
}
Words command_names(const Place &) {
    Words words;
    for (const CommandSpec &spec : commands()) {
        words.emplace_back(spec.name);
    }
    return words;
}

/// Objects of the type named by the previous word.
Words of_kind(const Place &place) {
    const std::string &kind = place.words[1];
    if (kind == "pin") {
        return any_pins(place);
    }
    if (kind.starts_with("param")) {
        return any_params(place);
    }
    if (kind.starts_with("sig")) {
        return signals(place);
    }
    if (kind.starts_with("funct")) {
        return functs(place);
    }
    if (kind == "thread") {
        return threads(place);
    }
    if (kind == "comp") {
        return components(place);
    }
    return kind == "all" ? values(place) : Words{};
}

/// Words of a command; the last one may repeat when `repeats` is set.
struct Grammar {
    std::string_view command;
    Candidates words[3];
    bool repeats = false;
};

constexpr Grammar GRAMMARS[] = {
    {"loadrt", {modules, module_parameters}, true},
    {"loadusr", {program}, true},
    {"waitusr", {programs}},
    {"unload", {loaded}},
    {"unloadrt", {loaded_modules}},
    {"unloadusr", {programs}},
    {"lock", {lock_kinds}},
    {"unlock", {unlock_kinds}},
    {"net", {signals, pins_to_link}, true},
    {"linkpp", {pins_to_link, pins_to_link}},
    {"linkps", {pins_to_link, signals}},
    {"linksp", {signals, pins_to_link}},
    {"unlinkp", {linked_pins}},
    {"newsig", {signals, types}},
    {"delsig", {signals}},
    {"alias", {pin_or_param, of_kind}},
    {"unalias", {pin_or_param, of_kind}},
    {"setp", {settable}},
    {"getp", {values}},
    {"ptype", {values}},
    {"sets", {signals}},
    {"gets", {signals}},
    {"stype", {signals}},
    {"addf", {functs, threads}},
    {"initf", {functs, threads}},
    {"delf", {functs, threads}},
    {"show", {show_kinds, of_kind}, true},
    {"list", {list_kinds, of_kind}, true},
    {"save", {save_kinds, files}},
    {"status", {status_kinds}},
    {"source", {sources}},
    {"debug", {levels}},
    {"help", {command_names}},
};

Candidates candidates_at(const Place &place) {
    if (place.words.empty()) {
        return command_names;
    }
    const auto grammar = std::find_if(std::begin(GRAMMARS), std::end(GRAMMARS),
                                      [&](const Grammar &one) { return one.command == place.words[0]; });
    if (grammar == std::end(GRAMMARS)) {
        return nullptr;
    }
    const std::span<const Candidates> words(grammar->words);
    std::size_t at = place.words.size() - 1;
    const auto known =
        static_cast<std::size_t>(std::find(words.begin(), words.end(), nullptr) - words.begin());
    if (at >= known && grammar->repeats) {
        at = known - 1;
    }
    return at < known ? words[at] : nullptr;
}

}  // namespace

std::vector<std::string> completions(Session &session, const std::string &line) {
    Place place{session, {}, {}};
    const std::size_t blank = line.find_last_of(" \t");
    place.start = blank == std::string::npos ? line : line.substr(blank + 1);
    for (const std::string &word : mw::split_words(line.substr(0, blank == std::string::npos ? 0 : blank))) {
        if (!isArrow(word)) {
            place.words.push_back(word);
        }
    }
    const Candidates candidates = candidates_at(place);
    Words words = candidates == nullptr ? Words{} : candidates(place);
    std::erase_if(words, [&](const std::string &word) { return !word.starts_with(place.start); });
    std::sort(words.begin(), words.end());
    words.erase(std::unique(words.begin(), words.end()), words.end());
    return words;
}

std::string common_beginning(const std::vector<std::string> &words) {
    if (words.empty()) {
        return "";
    }
    std::string common = words[0];
    for (const std::string &word : words) {
        const auto end = std::mismatch(common.begin(), common.end(), word.begin(), word.end()).first;
        common.erase(end, common.end());
    }
    return common;
}

}  // namespace mw::hal::script
