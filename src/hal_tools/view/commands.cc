// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal_tools/view/commands.hh"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>

#include <fmt/format.h>

#include "base/text.hh"
#include "hal/host/host_client.hh"
#include "hal_tools/view/capture.hh"
#include "hal_tools/view/latency.hh"
#include "hal_tools/view/netlist.hh"
#include "hal_tools/view/options.hh"
#include "hal_tools/view/terminal.hh"

namespace mw::hal::view {

namespace {

constexpr const char *USAGE =
    "usage: millwright hal [COMMAND ...]      looks at the running HAL\n"
    "\n"
    "  (no command) [NAME...]          pins, signals and threads live on the terminal; NAMEs are watched\n"
    "  watch NAME... [--every S] [--count N]\n"
    "                                  a line of values every S seconds (default 0.5)\n"
    "  capture NAME... [-o FILE.csv|.png|.svg]...\n"
    "                                  records up to 16 pins, signals or parameters in realtime; CSV to "
    "standard\n"
    "                                  output without -o\n"
    "      --samples N (1000)  --every N (1: each period)  --thread NAME\n"
    "      --trigger NAME rising|falling|either|above|below LEVEL\n"
    "      --pre PERCENT (10)          part of the record before the trigger\n"
    "      --timeout S (10)            give up, or with --force record what is there\n"
    "  graph [-o FILE.svg|.png|.pdf|.dot] [--only GLOB] [--values] [--unlinked]\n"
    "                                  draws components and signals (default: dot text to standard output)\n"
    "  latency [--base PERIOD] [--servo PERIOD] [--seconds S] [-o FILE.png|.svg|.csv]\n"
    "                                  latency of threads in a realtime process of its own (PERIOD: 25us, "
    "1ms)\n";

using Words = std::vector<std::string>;

int report(const Result<> &result, const char *program = "millwright hal") {
    if (!result) {
        std::fprintf(stderr, "%s: %s\n", program, result.error().str().c_str());
        return 1;
    }
    return 0;
}

void nap(double seconds) {
    timespec pause{static_cast<time_t>(seconds), static_cast<long>((seconds - std::floor(seconds)) * 1e9)};
    nanosleep(&pause, nullptr);
}

/// Sets `into` to the option's number.
template <class T>
Option number_option(const std::string &name, T &into, double low, double high) {
    return {name, 1, [&into, low, high](const Words &words) -> Result<> {
                const auto number = number_in(words[0], low, high);
                if (!number) {
                    return std::unexpected(number.error());
                }
                into = static_cast<T>(*number);
                return {};
            }};
}

Option text_option(const std::string &name, std::string &into) {
    return {name, 1, [&into](const Words &words) -> Result<> {
                into = words[0];
                return {};
            }};
}

Option flag(const std::string &name, bool &into) {
    return {name, 0, [&into](const Words &) -> Result<> {
                into = true;
                return {};
            }};
}

Option period_option(const std::string &name, std::int64_t &into) {
    return {name, 1, [&into](const Words &words) -> Result<> {
                const auto period = parse_period(words[0]);
                if (!period) {
                    return std::unexpected(period.error());
                }
                into = *period;
                return {};
            }};
}

// ---- watch

Result<> watch_lines(Hal &hal, const Words &names, double every_s, long count,
                     volatile std::sig_atomic_t &stop) {
    // Values stand below their names.
    const auto add_column = [](std::string &line, const std::string &text, const std::string &name) {
        constexpr std::size_t LEAST = 12;
        line += (line.empty() ? "" : " ") + fmt::format("{:>{}}", text, std::max(LEAST, name.size()));
    };
    std::string head;
    for (const std::string &name : names) {
        add_column(head, name, name);
    }
    for (long done = 0; (count <= 0 || done < count) && stop == 0; ++done) {
        if (done > 0) {
            nap(every_s);
        }
        std::string line;
        for (const std::string &name : names) {
            auto value = hal.get(name);
            if (!value) {
                value = hal.get_signal(name);
            }
            if (!value) {
                return fail(fmt::format("there is no pin, parameter or signal '{}'", name));
            }
            add_column(line, value->str(), name);
        }
        if (done == 0) {
            std::puts(head.c_str());
        }
        std::puts(line.c_str());
        std::fflush(stdout);
    }
    return {};
}

Result<> watch(const Words &words, volatile std::sig_atomic_t &stop) {
    double every_s = 0.5;
    long count = 0;
    const auto names = parse_options(
        words, {number_option("--every", every_s, 0.001, 3600), number_option("--count", count, 1, 1e9)});
    if (!names) {
        return std::unexpected(names.error());
    }
    if (names->empty()) {
        return fail("watch needs the name of a pin, parameter or signal");
    }
    const auto host = HostClient::connect(default_instance());
    return host ? watch_lines((*host)->hal(), *names, every_s, count, stop) : std::unexpected(host.error());
}

// ---- capture

struct CaptureCommand {
    CaptureRequest request;
    Words outputs;
    std::string thread;
    double timeout_s = 10.0;
    double pre_percent = -1.0;
    bool isForced = false;
};

Result<TriggerKind> trigger_kind(const std::string &word) {
    static constexpr std::pair<const char *, TriggerKind> KINDS[] = {{"rising", TriggerKind::RISING},
                                                                     {"falling", TriggerKind::FALLING},
                                                                     {"either", TriggerKind::EITHER},
                                                                     {"above", TriggerKind::ABOVE},
                                                                     {"below", TriggerKind::BELOW}};
    for (const auto &[name, kind] : KINDS) {
        if (word == name) {
            return kind;
        }
    }
    return fail(fmt::format("'{}' is no kind of trigger", word), {},
                "rising, falling, either, above and below are");
}

Result<> take_trigger(CaptureRequest &request, const Words &words) {
    const auto kind = trigger_kind(words[1]);
    const auto level = number_in(words[2], -1e300, 1e300);
    if (!kind) {
        return std::unexpected(kind.error());
    }
    if (!level) {
        return std::unexpected(level.error());
    }
    request.trigger_name = words[0];
    request.trigger = *kind;
    request.level = *level;
    return {};
}

Result<CaptureCommand> parse_capture(const Words &words) {
    CaptureCommand command;
    CaptureRequest &request = command.request;
    auto names = parse_options(
        words, {number_option("--samples", request.samples, 1, 1 << 24),
                number_option("--every", request.every, 1, 1e6),
                number_option("--pre", command.pre_percent, 0, 99.9),
                number_option("--timeout", command.timeout_s, 0, 1e6),
                text_option("--thread", command.thread),
                flag("--force", command.isForced),
                {"--trigger", 3, [&](const Words &taken) { return take_trigger(request, taken); }},
                {"-o", 1, [&](const Words &taken) -> Result<> {
                     command.outputs.push_back(taken[0]);
                     return {};
                 }}});
    if (!names) {
        return std::unexpected(names.error());
    }
    request.names = std::move(*names);
    const bool hasTrigger = request.trigger != TriggerKind::NONE;
    request.pretrigger = (command.pre_percent >= 0 ? command.pre_percent : hasTrigger ? 10.0 : 0.0) / 100.0;
    return command;
}

/// Waits for the end of the record; after the timeout it is forced, or given up.
Result<> wait_for_record(const Hal &hal, Capture &capture, const CaptureCommand &command,
                         volatile std::sig_atomic_t &stop) {
    constexpr double STEP_S = 0.01;
    double waited_s = 0;
    bool isForced = false;
    while (capture.state() != CaptureState::DONE) {
        if (stop != 0) {
            return fail("stopped before the record was complete");
        }
        if (capture.state() == CaptureState::REFUSED) {
            return fail("the module capture refused the settings");
        }
        if (waited_s > command.timeout_s && !hal.isRunning()) {
            return fail("the threads are stopped", {}, "halcmd start starts them");
        }
        if (waited_s > command.timeout_s && capture.state() != CaptureState::TRIGGERED) {
            if (!command.isForced || isForced) {
                return fail(fmt::format("no trigger within {} s", command.timeout_s), {},
                            isForced ? "is the thread running (halcmd start)?" : "--force records anyway");
            }
            capture.force();
            isForced = true;
            waited_s = 0;
        }
        nap(STEP_S);
        waited_s += STEP_S;
    }
    return {};
}

Result<> capture(const Words &words, volatile std::sig_atomic_t &stop) {
    const auto command = parse_capture(words);
    if (!command) {
        return std::unexpected(command.error());
    }
    const auto host = HostClient::connect(default_instance());
    if (!host) {
        return std::unexpected(host.error());
    }
    auto capture = Capture::open(**host, command->thread);
    if (!capture) {
        return std::unexpected(capture.error());
    }
    Result<> done = capture->begin(command->request);
    if (done) {
        done = wait_for_record((*host)->hal(), *capture, *command, stop);
    }
    if (!done) {
        return done;
    }
    const auto record = capture->record();
    if (!record) {
        return std::unexpected(record.error());
    }
    for (const std::string &name : record->moved) {
        std::fprintf(stderr, "warning: '%s' was linked or unlinked meanwhile; its values may be old\n",
                     name.c_str());
    }
    if (command->outputs.empty()) {
        std::fputs(to_csv(*record).c_str(), stdout);
    }
    for (const std::string &path : command->outputs) {
        const Result<> written =
            write_record(*record, fmt::format("HAL capture, {} samples", record->times_s.size()), path);
        if (!written) {
            return written;
        }
    }
    return {};
}

// ---- graph, latency

Result<> graph(const Words &words) {
    NetlistOptions options;
    std::string path;
    const auto rest = parse_options(words, {text_option("-o", path), text_option("--only", options.glob),
                                            flag("--values", options.showsValues),
                                            flag("--unlinked", options.showsUnlinked)});
    if (!rest) {
        return std::unexpected(rest.error());
    }
    if (!rest->empty()) {
        return fail(fmt::format("graph takes no word '{}'", rest->front()));
    }
    const auto host = HostClient::connect(default_instance());
    if (!host) {
        return std::unexpected(host.error());
    }
    if (path.empty()) {
        std::fputs(netlist_dot((*host)->hal(), options).c_str(), stdout);
        return {};
    }
    return write_netlist((*host)->hal(), options, path);
}

/// Threads of the two periods; a base period of 0 leaves that thread out.
std::vector<LatencyThread> threads_of(std::int64_t base_ns, std::int64_t servo_ns) {
    std::vector<LatencyThread> threads;
    if (base_ns > 0) {
        threads.push_back({"base", base_ns, 100});
    }
    threads.push_back({"servo", servo_ns, 1000});
    return threads;
}

Result<> latency(const Words &words, volatile std::sig_atomic_t &stop) {
    LatencyOptions options;
    std::int64_t base_ns = 0, servo_ns = 1'000'000;
    std::string path;
    const auto rest =
        parse_options(words, {period_option("--base", base_ns), period_option("--servo", servo_ns),
                              number_option("--seconds", options.seconds, 0.01, 1e7), text_option("-o", path),
                              text_option("--text", options.note)});
    if (!rest) {
        return std::unexpected(rest.error());
    }
    if (!rest->empty()) {
        return fail(fmt::format("latency takes no word '{}'", rest->front()));
    }
    options.threads = threads_of(base_ns, servo_ns);
    options.showsBars = true;
    options.isLive = ::isatty(STDOUT_FILENO) != 0;
    (path.ends_with(".csv") ? options.csv_path : options.picture_path) = path;
    return run_latency(options, stop);
}

Result<> live(const Words &names, volatile std::sig_atomic_t &stop) {
    const auto host = HostClient::connect(default_instance());
    if (!host) {
        return std::unexpected(host.error());
    }
    WatchModel model((*host)->hal());
    for (const std::string &name : names) {
        model.watch(name);
    }
    if (!names.empty()) {
        model.open_page(Page::WATCH);
    }
    return run_terminal(model, stop);
}

}  // namespace

int command_hal(const Words &words, volatile std::sig_atomic_t &stop) {
    const std::string command = words.empty() ? "" : words[0];
    const Words rest(words.empty() ? words.begin() : words.begin() + 1, words.end());
    const bool isHelp =
        std::ranges::any_of(words, [](const std::string &word) { return word == "--help" || word == "-h"; });
    if (isHelp || command == "help") {
        std::fputs(USAGE, stdout);
        return 0;
    }
    if (command == "watch") {
        return report(watch(rest, stop));
    }
    if (command == "capture") {
        return report(capture(rest, stop));
    }
    if (command == "graph") {
        return report(graph(rest));
    }
    if (command == "latency") {
        return report(latency(rest, stop));
    }
    if (!command.empty() && (command[0] == '-' || command.find('.') == std::string::npos)) {
        std::fprintf(stderr, "millwright hal: unknown command '%s'; see millwright hal --help\n",
                     command.c_str());
        return 2;
    }
    return report(live(words, stop));
}

int latency_test(const Words &words, volatile std::sig_atomic_t &stop) {
    LatencyOptions options;
    bool wantsHelp = false;
    const auto rest = parse_options(words, {number_option("--seconds", options.seconds, 0.01, 1e7),
                                            text_option("-o", options.picture_path),
                                            flag("--help", wantsHelp), flag("-h", wantsHelp)});
    if (wantsHelp) {
        std::puts(
            "usage: latency-test [base-period [servo-period]] [--seconds S] [-o FILE.png|.svg]\n"
            "  periods as 25us, 1ms or nanoseconds; base-period 0: servo thread only. Default: 25us 1ms");
        return 0;
    }
    std::int64_t periods[2] = {25'000, 1'000'000};
    Result<> done = rest ? Result<>{} : std::unexpected(rest.error());
    for (std::size_t i = 0; done && i < rest->size(); ++i) {
        if (i == 0 && (*rest)[0] == "0") {
            periods[0] = 0;
            continue;
        }
        const auto period = i < 2 ? parse_period((*rest)[i]) : fail("latency-test takes two periods");
        done = period ? Result<>{} : std::unexpected(period.error());
        periods[i < 2 ? i : 0] = period.value_or(0);
    }
    if (done) {
        options.threads = threads_of(periods[0], periods[1]);
        options.isLive = ::isatty(STDOUT_FILENO) != 0;
        done = run_latency(options, stop);
    }
    return report(done, "latency-test");
}

int latency_histogram(const Words &words, volatile std::sig_atomic_t &stop) {
    LatencyOptions options;
    std::int64_t base_ns = 25'000, servo_ns = 1'000'000;
    int base_bin_ns = 100, servo_bin_ns = 100;
    double without_effect = 0;
    bool hasNoBase = false, wantsHelp = false, isIgnored = false;
    const auto rest = parse_options(
        words,
        {period_option("--base", base_ns), period_option("--servo", servo_ns),
         number_option("--bbinsize", base_bin_ns, 1, 1e6), number_option("--sbinsize", servo_bin_ns, 1, 1e6),
         number_option("--bbins", without_effect, 1, 1e6), number_option("--sbins", without_effect, 1, 1e6),
         number_option("--logscale", without_effect, 0, 1), text_option("--text", options.note),
         number_option("--seconds", options.seconds, 0.01, 1e7), text_option("-o", options.picture_path),
         text_option("--csv", options.csv_path), flag("--nobase", hasNoBase), flag("--show", isIgnored),
         flag("--verbose", isIgnored), flag("--nox", isIgnored), flag("--help", wantsHelp),
         flag("-?", wantsHelp)});
    if (wantsHelp) {
        std::puts(
            "usage: latency-histogram [--base ns] [--servo ns] [--nobase] [--bbinsize ns] [--sbinsize ns]\n"
            "                         [--text note] [--seconds S] [-o FILE.png|.svg] [--csv FILE]\n"
            "  prints histograms at the end (Ctrl-C, or after S seconds). --bbins, --sbins, --logscale, "
            "--show,\n"
            "  --verbose and --nox are taken and have no effect: all bins are counted and shown.");
        return 0;
    }
    Result<> done = rest ? Result<>{} : std::unexpected(rest.error());
    if (done) {
        if (isIgnored || without_effect > 0) {
            std::fputs("latency-histogram: --bbins, --sbins, --logscale, --show, --verbose and --nox have no "
                       "effect: "
                       "all bins are counted and shown\n",
                       stderr);
        }
        options.threads = threads_of(hasNoBase ? 0 : base_ns, servo_ns);
        options.threads.back().bin_ns = servo_bin_ns;
        if (!hasNoBase) {
            options.threads.front().bin_ns = base_bin_ns;
        }
        options.showsBars = true;
        options.isLive = ::isatty(STDOUT_FILENO) != 0;
        done = run_latency(options, stop);
    }
    return report(done, "latency-histogram");
}

}  // namespace mw::hal::view
