// SPDX-License-Identifier: GPL-2.0-or-later
#include "programs/setup/configurations.hh"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "base/atomic_file.hh"
#include "base/ini/ini_file.hh"
#include "base/own_place.hh"
#include "base/text.hh"
#include "base/unfinished_folder.hh"

namespace mw::programs {
namespace {

namespace fs = std::filesystem;

std::string home_folder() {
    const char *const home = std::getenv("HOME");
    return home != nullptr ? home : "/";
}

std::string resource_file() {
    return home_folder() + "/.linuxcncrc";
}

/// Samples of this build or installation; empty if there are none.
std::string sample_folder() {
    for (const char *place : {"/../share/millwright/configs", "/../../../configs"}) {
        const std::string folder = program_folder() + place;
        if (isFolder(folder)) {
            return canonical_path(folder);
        }
    }
    return {};
}

/// Reads the machine of an INI file; false for a file that is only included by others.
bool read_machine(const std::string &path, Configuration &configuration) {
    diagnostics::Sink ignored;
    const auto file = ini::IniFile::load(path, ignored);
    if (!file.has_value() || !file->hasSection("EMC") || !file->hasSection("KINS")) {
        return false;
    }
    const ini::IniEntry *const machine = file->find("EMC", "MACHINE");
    configuration.machine = machine != nullptr ? machine->value : "";
    return true;
}

void add_group(std::vector<ConfigurationGroup> &groups, std::set<std::string> &seen,
               ConfigurationGroup group) {
    constexpr int DEEPEST = 4;
    group.folder = canonical_path(group.folder);
    if (group.folder.empty() || !isFolder(group.folder) || !seen.insert(group.folder).second) {
        return;
    }
    std::error_code error;
    fs::recursive_directory_iterator at(group.folder, fs::directory_options::skip_permission_denied, error),
        end;
    for (; !error && at != end; at.increment(error)) {
        if (at.depth() >= DEEPEST) {
            at.disable_recursion_pending();
        }
        Configuration one{at->path().string(), at->path().lexically_relative(group.folder).string(), {}};
        if (at->path().extension() == ".ini" && read_machine(one.ini, one)) {
            group.configurations.push_back(std::move(one));
        }
    }
    std::ranges::sort(group.configurations, {}, &Configuration::name);
    if (!group.configurations.empty()) {
        groups.push_back(std::move(group));
    }
}

}  // namespace

bool isFolder(const std::string &path) {
    std::error_code error;
    return fs::is_directory(path, error);
}

std::string canonical_path(const std::string &path) {
    std::error_code error;
    const fs::path whole = fs::canonical(path, error);
    return error ? path : whole.string();
}

std::vector<ConfigurationGroup> find_configurations() {
    std::vector<ConfigurationGroup> groups;
    std::set<std::string> seen;
    add_group(groups, seen, {"yours", home_folder() + "/millwright/configs", false, {}});
    add_group(groups, seen, {"yours", home_folder() + "/linuxcnc/configs", false, {}});
    const char *const more = std::getenv("LINUXCNC_AUX_CONFIGS");
    std::istringstream folders(more != nullptr ? more : "");
    for (std::string folder; std::getline(folders, folder, ':');) {
        const bool of_home = folder.starts_with("~/");
        add_group(
            groups, seen,
            {"of LINUXCNC_AUX_CONFIGS", of_home ? home_folder() + folder.substr(1) : folder, false, {}});
    }
    add_group(groups, seen, {"of other packages", AUX_EXAMPLES, true, {}});
    add_group(groups, seen, {"samples", sample_folder(), true, {}});
    return groups;
}

Result<std::string> copy_sample(const ConfigurationGroup &group, const Configuration &configuration) {
    const fs::path from = fs::path(configuration.ini).parent_path();
    const fs::path base = fs::path(home_folder()) / "millwright";
    const fs::path name = from.lexically_relative(group.folder);
    const fs::path to = base / "configs" / (name == "." ? fs::path(group.folder).filename() : name);
    const fs::path programs = fs::path(group.folder).parent_path() / "nc_files";
    std::error_code error;
    if (!fs::exists(to)) {
        fs::create_directories(to.parent_path(), error);
        auto partly = UnfinishedFolder::create(to.string());
        if (partly.has_value() && !error) {
            fs::permissions(partly->path(), fs::status(from, error).permissions() | fs::perms::owner_all,
                            error);
            fs::copy(from, partly->path(), fs::copy_options::recursive, error);
        }
        const bool copied = partly.has_value() && !error && partly->become_target();
        if (!copied && !error) {
            error = std::error_code(errno, std::system_category());
        }
        if (error) {
            return fail("the sample cannot be copied to '" + to.string() + "': " + error.message());
        }
    }
    if (isFolder(programs.string()) && !fs::exists(fs::symlink_status(base / "nc_files", error))) {
        fs::create_directory_symlink(programs, base / "nc_files", error);
        if (error) {
            return fail("cannot create a link to the programs of the sample: " + error.message());
        }
    }
    return (to / fs::path(configuration.ini).filename()).string();
}

std::string last_configuration() {
    diagnostics::Sink ignored;
    const auto file = ini::IniFile::load(resource_file(), ignored);
    const ini::IniEntry *const entry = file.has_value() ? file->find("PICKCONFIG", "LAST_CONFIG") : nullptr;
    return entry != nullptr ? entry->value : std::string();
}

Result<> remember_configuration(const std::string &ini) {
    std::string text;
    bool inside = false, kept = false;
    const std::string setting = "LAST_CONFIG = " + ini + '\n';
    std::ifstream file(resource_file());
    for (std::string line; std::getline(file, line);) {
        const std::string_view words = trim(line);
        if (words.starts_with('[')) {
            inside = words.starts_with("[PICKCONFIG]");
            text += line + '\n' + (inside && !kept ? setting : "");
            kept |= inside;
        } else if (!inside || !words.starts_with("LAST_CONFIG")) {
            text += line + '\n';
        }
    }
    return write_file_atomically(resource_file(), text + (kept ? "" : "[PICKCONFIG]\n" + setting));
}

}  // namespace mw::programs
