// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/screen/hal/postgui.hh"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include <fmt/format.h>

#include "base/result.hh"
#include "base/text.hh"

namespace mw::screen {
namespace {

using ini::IniEntry;

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

}  // namespace mw::screen
