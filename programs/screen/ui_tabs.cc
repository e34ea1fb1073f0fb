// SPDX-License-Identifier: GPL-2.0-or-later
#include "programs/screen/ui_tabs.hh"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include <fmt/format.h>

#include "base/atomic_file.hh"
#include "base/text.hh"
#include "clients/screen/documents.hh"

namespace mw::programs {
namespace {

using ini::IniEntry;
using screen::Tab;

/// Prefix of "panel FILE".
constexpr std::string_view PANEL = "panel ";

bool isAddress(std::string_view command) {
    return command.starts_with("http://") || command.starts_with("https://");
}

/// Waits for the program; returns its exit status, or the reason why it was not run.
Result<int> run_and_wait(const std::vector<std::string> &words, const std::string &folder) {
    std::vector<std::string> owned = words;
    std::vector<char *> arguments;
    for (std::string &word : owned) {
        arguments.push_back(word.data());
    }
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
    pid_t pid = 0;
    const int error = ::posix_spawnp(&pid, arguments[0], &actions, nullptr, arguments.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    if (error != 0) {
        return fail(std::strerror(error));
    }
    int status = 0;
    while (::waitpid(pid, &status, 0) < 0) {
        if (errno != EINTR) {
            return fail(std::strerror(errno));
        }
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
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
            const auto checked =
                text.has_value() ? screen::check_panel(*text) : std::unexpected(text.error());
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

std::vector<std::vector<std::string>> postgui_commands(const ini::IniFile &ini, const std::string &programs) {
    std::vector<std::vector<std::string>> commands;
    for (const IniEntry *entry : ini.find_all("HAL", "POSTGUI_HALFILE")) {
        const auto words = split_words(entry->value);
        if (words.empty()) {
            continue;
        }
        const bool is_tcl = words[0].ends_with(".tcl");
        auto &command = commands.emplace_back(
            is_tcl ? std::vector<std::string>{programs + "/haltcl", "-i", ini.path()}
                   : std::vector<std::string>{programs + "/halcmd", "-i", ini.path(), "-f"});
        command.insert(command.end(), words.begin(), words.end());
    }
    for (const IniEntry *entry : ini.find_all("HAL", "POSTGUI_HALCMD")) {
        auto &command = commands.emplace_back(std::vector<std::string>{programs + "/halcmd"});
        const auto words = split_words(entry->value);
        command.insert(command.end(), words.begin(), words.end());
    }
    return commands;
}

std::vector<std::string> run_postgui(const std::vector<std::vector<std::string>> &commands,
                                     const std::string &folder) {
    std::vector<std::string> notes;
    for (const auto &command : commands) {
        const auto status = run_and_wait(command, folder);
        if (!status.has_value() || *status != 0) {
            const std::string why =
                status.has_value() ? fmt::format("exit status {}", *status) : status.error().str();
            notes.push_back(
                fmt::format("[HAL]POSTGUI: {}: {}; standard error has more", fmt::join(command, " "), why));
        }
    }
    return notes;
}

}  // namespace mw::programs
