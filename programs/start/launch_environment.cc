// SPDX-License-Identifier: GPL-2.0-or-later
#include "programs/start/launch_environment.hh"

#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "base/own_place.hh"
#include "hal/script/session.hh"

namespace mw::programs {
namespace {

namespace fs = std::filesystem;

void set(const char *name, const std::string &value) {
    ::setenv(name, value.c_str(), 1);
}

/// Sets a variable unless the user has set it.
void offer(const char *name, const std::string &value) {
    ::setenv(name, value.c_str(), 0);
}

std::string old(const char *name) {
    const char *const value = std::getenv(name);
    return value != nullptr ? value : "";
}

/// The first existing folder; otherwise the first.
std::string folder_of(std::initializer_list<std::string> candidates) {
    std::error_code ignored;
    for (const std::string &candidate : candidates) {
        if (fs::is_directory(candidate, ignored)) {
            return fs::canonical(candidate, ignored).string();
        }
    }
    return *candidates.begin();
}

std::string first_value(const machine::LoadedConfig &loaded, const char *section, const char *key) {
    const ini::IniEntry *const entry = loaded.ini.find(section, key);
    return entry != nullptr ? entry->value : std::string();
}

void set_places(const std::string &home) {
    const std::string bin = program_folder();
    set("LINUXCNC_HOME", home);
    offer("LINUXCNCVERSION", "2.9");
    offer("LINUXCNC_TCL_DIR",
          folder_of({home + "/lib/tcl", home + "/lib/millwright/tcl", "/usr/lib/tcltk/linuxcnc"}));
    offer("LINUXCNC_EMCSH", ::access("/usr/bin/wish8.6", X_OK) == 0 ? "wish8.6" : "wish");
    offer("LINUXCNC_HELP_DIR", folder_of({home + "/share/doc/linuxcnc", home + "/share/doc/millwright"}));
    offer("LINUXCNC_LANG_DIR",
          folder_of({home + "/share/linuxcnc/tcl/msgs", "/usr/share/linuxcnc/tcl/msgs"}));
    offer("LINUXCNC_NCFILES_DIR",
          folder_of({home + "/share/linuxcnc/ncfiles", "/usr/share/linuxcnc/ncfiles"}));
    offer("REALTIME", bin + "/realtime");
    offer("HAL_RTMOD_DIR", folder_of({home + "/lib/millwright/modules", bin + "/../components"}));
}

void set_hal_places(const std::vector<std::string> &before) {
    for (const std::string &folder : hal::script::default_library()) {
        std::error_code ignored;
        if (fs::is_directory(folder, ignored)) {
            offer("HALLIB_DIR", folder);
            break;
        }
    }
    std::string path;
    for (const std::string &folder : before) {
        path += folder + ":";
    }
    offer("HALLIB_PATH", path + ".:" + old("HALLIB_DIR"));
}

}  // namespace

void set_launch_environment(const machine::LoadedConfig &loaded, const StartSettings &settings) {
    const std::string home = fs::path(program_folder()).parent_path().string();
    const std::string folder = fs::path(settings.ini).parent_path().string();
    set("CONFIG_DIR", folder);
    set("INI_FILE_NAME", settings.ini);
    set("PATH", folder + "/bin:" + program_folder() + ":" + old("HOME") + "/.local/bin:" + old("PATH"));
    set_places(home);
    set_hal_places(settings.options.hal_folders);
    set("HALCMD", settings.options.kept_going ? "halcmd -k" : "halcmd");
    set("TRAJ_COORDINATES", first_value(loaded, "TRAJ", "COORDINATES"));
    set("KINS_KINEMATICS", first_value(loaded, "KINS", "KINEMATICS"));
    const std::string platform = old("LINUXCNC_OPENGL_PLATFORM");
    if (platform.empty() || platform == "glx") {
        set("PYOPENGL_PLATFORM", "x11");
    }
    // Programs check that the file exists. find_machine() and the Python package ignore the name of an INI
    // file.
    const std::string channels = first_value(loaded, "EMC", "NML_FILE");
    const std::string path = (fs::path(folder) / channels).string();
    std::error_code ignored;
    const bool exists = !channels.empty() && fs::exists(path, ignored);
    offer("NMLFILE", exists ? path : settings.ini);
}

}  // namespace mw::programs
