// SPDX-License-Identifier: GPL-2.0-or-later
#include <cstdio>

#include "hal/host/host_client.hh"
#include "hal_tools/programs/command_line.hh"

namespace mw::hal::tools {
namespace {

constexpr const char *USAGE = R"(usage: realtime start|stop|restart|status

  start    starts a realtime process that stays until it is told to end
  stop     ends it, and the programs that have components in it
  restart  both
  status   says whether it runs; the exit status is 0 when it does
)";

int start() {
    const std::string instance = default_instance();
    if (isHostAlive(instance)) {
        return 0;
    }
    const auto host = HostClient::start(instance, MessagesTo::FILE);
    if (!host) {
        std::fprintf(stderr, "realtime: %s\n", host.error().str().c_str());
    }
    return host ? 0 : 1;
}

int status() {
    const std::string instance = default_instance();
    const bool isAlive = isHostAlive(instance);
    std::printf("the realtime process of instance '%s' %s\n", instance.c_str(),
                isAlive ? "is running" : "is not running");
    return isAlive ? 0 : 1;
}

}  // namespace

int realtime(const std::vector<std::string> &arguments) {
    const std::string what = arguments.size() == 1 ? arguments[0] : "";
    if (what == "start") {
        return start();
    }
    if (what == "stop") {
        return end_running("realtime");
    }
    if (what == "restart") {
        const int stopped = end_running("realtime");
        return stopped != 0 ? stopped : start();
    }
    if (what == "status") {
        return status();
    }
    const bool isHelp = what == "-h" || what == "--help";
    std::fputs(USAGE, isHelp ? stdout : stderr);
    return isHelp ? 0 : 2;
}

}  // namespace mw::hal::tools
