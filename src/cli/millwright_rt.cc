// SPDX-License-Identifier: GPL-2.0-or-later
// millwright-rt: the realtime process of an instance. Started by halrun, realtime and millwright; not by
// hand.
#include <unistd.h>

#include <cstdio>
#include <cstring>
#include <string>

#include "base/own_place.hh"
#include "base/text.hh"
#include "hal/core/hal.hh"
#include "hal/host/host_server.hh"

namespace {

constexpr const char *USAGE =
    "usage: millwright-rt [--instance NAME] [--cpu N | --simulation]\n"
    "Owns the HAL of an instance and runs its realtime threads until it is told to end.\n"
    "  --instance NAME  default: $MILLWRIGHT_INSTANCE, else 'default'\n"
    "  --cpu N          processor of the threads (default: the last isolated one, else the last)\n"
    "  --simulation     ask for no realtime priority\n";

/// Tells whoever started us: "ready" or what is wrong.
void tell(int fd, const std::string &text) {
    if (fd >= 0) {
        (void)!::write(fd, text.data(), text.size());
        ::close(fd);
    }
}

struct Arguments {
    mw::hal::HostServerOptions options;
    int ready_fd = -1;
    bool isGood = true;
};

Arguments read_arguments(int argc, char **argv) {
    Arguments arguments;
    arguments.options.instance = mw::hal::default_instance();
    for (int i = 1; i < argc; ++i) {
        const std::string option = argv[i];
        if (option == "--simulation") {
            arguments.options.realtime.isSimulation = true;
            continue;
        }
        const std::string value = i + 1 < argc ? argv[++i] : "";
        const auto number = mw::parse_int(value);
        if (option == "--instance" && !value.empty()) {
            arguments.options.instance = value;
        } else if (option == "--cpu" && number && *number >= 0 && *number < 4096) {
            arguments.options.realtime.cpu = static_cast<int>(*number);
        } else if (option == "--ready-fd" && number && *number >= 0) {
            arguments.ready_fd = static_cast<int>(*number);
        } else if (option == "--starter-fd" && number && *number >= 0) {
            arguments.options.controller_fd = static_cast<int>(*number);
        } else {
            arguments.isGood = false;
        }
    }
    return arguments;
}

}  // namespace

int main(int argc, char **argv) {
    mw::tell_when_memory_ends();
    if (argc == 2 && (std::strcmp(argv[1], "--help") == 0 || std::strcmp(argv[1], "-h") == 0)) {
        std::fputs(USAGE, stdout);
        return 0;
    }
    const Arguments arguments = read_arguments(argc, argv);
    if (!arguments.isGood) {
        std::fputs(USAGE, stderr);
        return 2;
    }
    auto server = mw::hal::HostServer::create(arguments.options);
    if (!server) {
        const std::string text = server.error().str();
        if (arguments.ready_fd < 0) {
            std::fprintf(stderr, "millwright-rt: %s\n", text.c_str());
        }
        tell(arguments.ready_fd, text);
        return 1;
    }
    tell(arguments.ready_fd, "ready");
    (*server)->run();
    return 0;
}
