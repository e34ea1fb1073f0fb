// SPDX-License-Identifier: GPL-2.0-or-later
// millwright-rt: the realtime process of an instance. Started by halrun, realtime and millwright, not by
// users.
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <string>
#include <vector>

#include "base/capabilities.hh"
#include "base/language/language.hh"
#include "base/memory_killer.hh"
#include "base/options/command_line.hh"
#include "base/own_place.hh"
#include "hal/core/instance.hh"
#include "hal/host/host_server.hh"

namespace {

constexpr int MAX_CPU = 4095, MAX_FD = 1 << 20;

/// Reports "ready" or the error to the starter.
void tell(int fd, const std::string &text) {
    if (fd >= 0) {
        (void)!::write(fd, text.data(), text.size());
        ::close(fd);
    }
}

struct Arguments {
    mw::hal::HostServerOptions options;
    int ready_fd = -1, cpu = -1;

    mw::options::CommandLine line() {
        mw::options::CommandLine line("millwright-rt [options]",
                                      "Owns the HAL of an instance and runs its realtime threads until it "
                                      "receives the command to end.\n");
        options.instance = mw::hal::default_instance();
        line.text("--instance", "NAME", "default: $MILLWRIGHT_INSTANCE, else 'default'", options.instance);
        line.number("--cpu", "N", "processor of the threads (default: the last isolated one, else the last)",
                    cpu, 0, MAX_CPU);
        line.flag("--simulation", "run without realtime priority", options.realtime.is_simulation);
        line.number("--ready-fd", "N", "", ready_fd, 0, MAX_FD);
        line.number("--starter-fd", "N", "", options.controller_fd, 0, MAX_FD);
        return line;
    }
};

}  // namespace

int main(int argc, char **argv) {
    std::signal(SIGPIPE, SIG_IGN);  // the end of its starter or terminal must not end this process
    mw::tell_when_memory_ends();
    mw::use_permitted_capabilities();
    static_cast<void>(mw::lower_oom_score(-900));  // `millwright doctor` reports a missing right
    const std::vector<std::string> words(argv + 1, argv + argc);
    Arguments arguments;
    const mw::options::CommandLine line = arguments.line();
    if (mw::options::wantsHelp(words)) {
        std::fputs(line.help().c_str(), stdout);
        return 0;
    }
    const auto parsed = line.parse(words);
    if (!parsed) {
        mw::language::tell("millwright-rt", parsed.error());
        return 2;
    }
    if (arguments.cpu >= 0) {
        arguments.options.realtime.cpu = arguments.cpu;
    }
    auto server = mw::hal::HostServer::create(arguments.options);
    if (!server) {
        const std::string text = server.error().str();
        if (arguments.ready_fd < 0) {
            mw::language::tell("millwright-rt: " + text);
        }
        tell(arguments.ready_fd, text);
        return 1;
    }
    tell(arguments.ready_fd, "ready");
    (*server)->run();
    return 0;
}
