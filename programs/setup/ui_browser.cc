// SPDX-License-Identifier: GPL-2.0-or-later
#include "programs/setup/ui_browser.hh"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include <fmt/format.h>

#include "base/own_place.hh"

namespace mw::programs {

std::string screen_folder(const std::string &given) {
    const std::string here = program_folder();
    std::error_code error;
    for (const std::string &folder : {given, here + "/../share/millwright/web"}) {
        if (!folder.empty()) {
            const auto whole = std::filesystem::weakly_canonical(folder, error);
            return error ? folder : whole.string();
        }
    }
    return given;
}

Result<> check_screen(const std::string &folder) {
    std::error_code error;
    if (std::filesystem::is_regular_file(folder + "/index.html", error)) {
        return {};
    }
    return fail("The screen is not installed: " + folder + "/index.html is missing", {},
                "in the source folder, script/bootstrap --screen and script/screen build it");
}

void Browser::open(const std::string &address) {
    if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr) {
        return;
    }
    std::string program = "xdg-open", words = address;
    char *arguments[] = {program.data(), words.data(), nullptr};
    if (::posix_spawnp(&pid_, program.c_str(), nullptr, nullptr, arguments, environ) != 0) {
        fmt::print(stderr, "xdg-open cannot show the screen: open {} in a browser\n", address);
        pid_ = 0;
    }
}

void Browser::look() {
    if (pid_ > 0 && ::waitpid(pid_, nullptr, WNOHANG) != 0) {
        pid_ = 0;
    }
}

}  // namespace mw::programs
