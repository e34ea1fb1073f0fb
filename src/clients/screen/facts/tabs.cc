// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/screen/facts/tabs.hh"

#include <algorithm>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "base/atomic_file.hh"
#include "base/text.hh"
#include "clients/screen/facts/panel.hh"

namespace mw::screen {
namespace {

/// Prefix of "panel FILE".
constexpr std::string_view PANEL = "panel ";

bool isAddress(std::string_view command) {
    return command.starts_with("http://") || command.starts_with("https://");
}

}  // namespace

std::vector<Tab> tabs_of(const ini::IniFile &ini, diagnostics::Sink &sink) {
    const auto names = ini.find_all("DISPLAY", "EMBED_TAB_NAME"),
               commands = ini.find_all("DISPLAY", "EMBED_TAB_COMMAND");
    const auto locations = ini.find_all("DISPLAY", "EMBED_TAB_LOCATION");
    if (names.size() != commands.size()) {
        sink.error(fmt::format("[DISPLAY] has {} EMBED_TAB_NAME and {} EMBED_TAB_COMMAND: the screen shows "
                               "only panels that have both",
                               names.size(), commands.size()),
                   names.empty() ? commands[0]->place : names[0]->place);
    }
    std::vector<Tab> tabs;
    for (std::size_t i = 0; i < std::min(names.size(), commands.size()); ++i) {
        const std::string &command = commands[i]->value;
        Tab tab{names[i]->value, i < locations.size() ? locations[i]->value : "", Tab::Kind::PROGRAM,
                command};
        if (isAddress(command)) {
            tab.kind = Tab::Kind::FRAME;
        } else if (command.starts_with(PANEL)) {
            const std::string path = ini.resolve_path(trim(command.substr(PANEL.size())));
            const auto text = read_file(path);
            const auto checked = text.has_value() ? check_panel(*text) : std::unexpected(text.error());
            if (!checked.has_value()) {
                sink.error("[DISPLAY]EMBED_TAB_COMMAND: " + path + ": " + checked.error().str(),
                           commands[i]->place);
                continue;
            }
            tab.kind = Tab::Kind::PANEL;
            tab.content = *text;
        }
        tabs.push_back(std::move(tab));
    }
    return tabs;
}

std::vector<std::string> tab_programs(const std::vector<Tab> &tabs) {
    std::vector<std::string> commands;
    for (const Tab &tab : tabs) {
        if (tab.kind != Tab::Kind::PROGRAM) {
            continue;
        }
        std::string command = tab.content;
        for (const char *place : {"-x {XID}", "-x{XID}", "--xid={XID}", "{XID}"}) {
            for (std::size_t at = command.find(place); at != std::string::npos; at = command.find(place)) {
                command.erase(at, std::strlen(place));
            }
        }
        commands.push_back(std::move(command));
    }
    return commands;
}

}  // namespace mw::screen
