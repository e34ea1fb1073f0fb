// SPDX-License-Identifier: GPL-2.0-or-later
// motion-logger [FILE]: replaces the motion controller and writes its commands (man page
// motion-logger).
#include <time.h>

#include <cstdio>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "base/language/language.hh"
#include "base/stop_signals.hh"
#include "hal/host/host_client.hh"
#include "motion/logger/stand_in.hh"

namespace {

constexpr const char *NAME = "motion-logger";
constexpr const char *USAGE = "usage: motion-logger [FILE]\n"
                              "  replaces motmod and writes the commands of task; loadusr -W starts it\n";
constexpr long PERIOD_NS = 1000000;

struct CloseFile {
    void operator()(std::FILE *file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

std::int64_t monotonic_ns() {
    constexpr std::int64_t NS_PER_S = 1000000000;
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec * NS_PER_S + now.tv_nsec;
}

/// The log; standard output without a file name. Each line is written at once, because other programs read
/// it.
class Log {
  public:
    /// Creates or empties the file.
    mw::Result<> open(const std::string &path) {
        path_ = path;
        return path_.empty() ? mw::Result<>() : make();
    }
    /// Closes the file. The next line creates a new file, because other programs may have moved this one.
    mw::Result<> close() {
        auto made = path_.empty() || file_ != nullptr ? mw::Result<>() : make();
        file_.reset();
        return made;
    }
    void say(const std::string &line) {
        if (!path_.empty() && file_ == nullptr) {
            if (const auto made = make(); !made.has_value()) {
                mw::language::tell(NAME, made.error());
            }
        }
        std::FILE *const out = file_ != nullptr ? file_.get() : stdout;
        fmt::print(out, "{}\n", line);
        std::fflush(out);
    }

  private:
    mw::Result<> make() {
        file_.reset(std::fopen(path_.c_str(), "w"));
        return file_ != nullptr ? mw::Result<>() : mw::fail(fmt::format("cannot write '{}'", path_));
    }

    std::string path_;
    File file_;
};

mw::Result<> run(const std::string &path) {
    using namespace mw;
    Log log;
    if (auto opened = log.open(path); !opened.has_value()) {
        return opened;
    }
    auto host = hal::HostClient::connect(hal::default_instance());
    if (!host.has_value()) {
        return std::unexpected(host.error());
    }
    hal::Instance &hal = (*host)->hal();
    const auto component = hal.components().create(NAME);
    if (!component.has_value()) {
        return std::unexpected(component.error());
    }
    const auto reopen =
        hal.pins().create("motion-logger.reopen-log", hal::Type::BIT, hal::Dir::IO, *component);
    const auto in_position =
        hal.pins().create("motion.in-position", hal::Type::BIT, hal::Dir::OUT, *component);
    const auto block = hal.memory().shared_block(motion::Channels::SHMEM_KEY, sizeof(motion::Channels));
    for (const Error *error : {reopen.has_value() ? nullptr : &reopen.error(),
                               in_position.has_value() ? nullptr : &in_position.error(),
                               block.has_value() ? nullptr : &block.error()}) {
        if (error != nullptr) {
            return std::unexpected(*error);
        }
    }
    if (static_cast<motion::Channels *>(*block)->magic == motion::Channels::MAGIC) {
        return fail("a motion controller is loaded already", {}, "motion-logger replaces motmod");
    }
    auto *const channels = new (*block) motion::Channels();
    motion::StandIn stand_in(*channels, [&log](const std::string &line) { log.say(line); });
    channels->layout_bytes = sizeof(motion::Channels);
    channels->magic = motion::Channels::MAGIC;
    if (auto ready = hal.components().set_ready(*component); !ready.has_value()) {
        return ready;
    }
    constexpr timespec PERIOD{0, PERIOD_NS};
    while (stop_signal == 0 && !hal.host_status().end_reason().has_value()) {
        stand_in.step(monotonic_ns());
        // Reads the value's address each time, because pins may be linked at any time.
        auto *const isReopening = static_cast<volatile bool *>(**reopen);
        *static_cast<volatile bool *>(**in_position) = stand_in.isInPosition();
        if (*isReopening) {
            if (auto closed = log.close(); !closed.has_value()) {
                return closed;
            }
            *isReopening = false;
        }
        ::nanosleep(&PERIOD, nullptr);
    }
    channels->magic = 0;
    return {};
}

}  // namespace

int main(int argc, char **argv) {
    const std::string first = argc > 1 ? argv[1] : "";
    if (argc > 2 || first.starts_with("-")) {
        const bool requested = first == "--help" || first == "-h";
        std::fputs(mw::language::shown(USAGE).c_str(), requested ? stdout : stderr);
        return requested ? 0 : 2;
    }
    mw::catch_stop_signals();
    const auto ended = run(first);
    if (!ended.has_value()) {
        mw::language::tell(NAME, ended.error());
    }
    return ended.has_value() ? 0 : 1;
}
