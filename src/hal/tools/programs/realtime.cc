// SPDX-License-Identifier: GPL-2.0-or-later
#include <unistd.h>

#include <cstdio>
#include <string>

#include "base/language/language.hh"
#include "hal/host/host_client.hh"
#include "hal/tools/programs/command_line.hh"

namespace mw::hal::tools {
namespace {

constexpr const char *USAGE = R"(usage: realtime start|stop|restart|status|verify

  start    starts a realtime process that runs until stop
  stop     ends it, and the programs that have components in it
  restart  stop, then start
  status   reports whether it is running; exit status 0 if it is
  verify   starts a separate one and reports whether its threads have realtime priority and locked memory; 0 when they have
)";

int start() {
    const std::string instance = default_instance();
    if (isHostAlive(instance)) {
        return 0;
    }
    const auto host = HostClient::start(instance, MessagesTo::FILE);
    if (!host) {
        language::tell("realtime", host.error());
    }
    return host ? 0 : 1;
}

int status() {
    const std::string instance = default_instance();
    const bool alive = isHostAlive(instance);
    std::printf("the realtime process of instance '%s' %s\n", instance.c_str(),
                alive ? "is running" : "is not running");
    return alive ? 0 : 1;
}

/// Runs in a separate instance, so that it does not affect a running machine.
int verify() {
    auto host = HostClient::start("verify-" + std::to_string(::getpid()));
    Result<> done = host ? (*host)->control() : std::unexpected(host.error());
    const std::string missing = done ? (*host)->hal().host_status().realtime_missing() : "";
    const Result<> ended = host ? (*host)->shut_down() : Result<>{};
    done = done ? ended : done;
    if (!done) {
        language::tell("realtime", done.error());
        return 1;
    }
    std::printf("%s%s\n",
                missing.empty() ? "realtime priority and locked memory" : "no realtime: ", missing.c_str());
    return missing.empty() ? 0 : 1;
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
    if (what == "verify") {
        return verify();
    }
    const bool is_help = what == "-h" || what == "--help";
    std::fputs(language::shown(USAGE).c_str(), is_help ? stdout : stderr);
    return is_help ? 0 : 2;
}

}  // namespace mw::hal::tools
