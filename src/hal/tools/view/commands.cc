// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/tools/view/commands.hh"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>

#include <fmt/format.h>

#include "base/duration.hh"
#include "base/language/language.hh"
#include "base/options/command_line.hh"
#include "base/text.hh"
#include "hal/host/host_client.hh"
#include "hal/tools/view/capture.hh"
#include "hal/tools/view/latency.hh"
#include "hal/tools/view/netlist.hh"
#include "hal/tools/view/terminal.hh"

namespace mw::hal::view {

namespace {

constexpr const char *USAGE =
    "usage: millwright hal [COMMAND ...]      show the running HAL\n"
    "\n"
    "  (no command) [NAME...]  pins, signals and threads live on the terminal; NAMEs are watched\n"
    "  watch NAME...           prints a line of values periodically\n"
    "  capture NAME...         records up to 16 pins, signals or parameters in realtime\n"
    "  graph                   draws components and signals\n"
    "  latency                 latency of threads in a separate realtime process\n"
    "\n"
    "Each command has its own --help.\n";

using options::CommandLine, options::Words;

int report(const Result<> &result, const char *program = "millwright hal") {
    if (!result) {
        language::tell(program, result.error());
        return 1;
    }
    return 0;
}

void nap(double seconds) {
    const std::int64_t ns = to_ns(seconds);
    const timespec pause{ns / NS_PER_SECOND, ns % NS_PER_SECOND};
    nanosleep(&pause, nullptr);
}

/// Parses a period: 25us, 1ms, or nanoseconds.
void take_period(CommandLine &line, const std::string &names, const std::string &doc, std::int64_t &into) {
    line.take(names, 1, "PERIOD", doc, [&into](const Words &words) -> Result<> {
        const auto period = parse_period(words[0]);
        if (!period) {
            return std::unexpected(period.error());
        }
        into = *period;
        return {};
    });
}

// ---- watch

Result<> watch_lines(Instance &hal, const Words &names, double every_s, long count,
                     volatile std::sig_atomic_t &stop) {
    // Values are printed below their names.
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
            auto value = hal.values().get(name);
            if (!value) {
                value = hal.signals().get(name);
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

struct WatchCommand {
    Words names;
    double every_s = 0.5;
    long count = 0;

    CommandLine line() {
        CommandLine line("millwright hal watch NAME... [options]",
                         "Periodically prints a line with values of pins, parameters or signals.\n");
        line.number("--every", "S", "seconds between two lines (default 0.5)", every_s, 0.001, 3600);
        line.number("--count", "N", "number of lines (default: until stopped)", count, 1, 1000000000);
        line.rest(names);
        return line;
    }
};

Result<> watch(const WatchCommand &command, volatile std::sig_atomic_t &stop) {
    if (command.names.empty()) {
        return fail("watch needs the name of a pin, parameter or signal");
    }
    const auto host = HostClient::connect(default_instance());
    return host ? watch_lines((*host)->hal(), command.names, command.every_s, command.count, stop)
                : std::unexpected(host.error());
}

// ---- capture

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
    return fail(fmt::format("unknown trigger type '{}'", word), {},
                "use rising, falling, either, above or below");
}

Result<> take_trigger(CaptureRequest &request, const Words &words) {
    const auto kind = trigger_kind(words[1]);
    const auto level = parse_double(words[2]);
    if (!kind) {
        return std::unexpected(kind.error());
    }
    if (!level || !std::isfinite(*level)) {
        return fail(fmt::format("'{}' is not a level", words[2]));
    }
    request.trigger_name = words[0];
    request.trigger = *kind;
    request.level = *level;
    return {};
}

struct CaptureCommand {
    CaptureRequest request;
    Words outputs;
    std::string thread;
    double timeout_s = 10.0;
    double pre_percent = -1.0;
    bool forced = false;

    CommandLine line() {
        CommandLine line(
            "millwright hal capture NAME... [options]",
            "Records up to 16 pins, signals or parameters in realtime. CSV to standard output without -o.\n");
        line.texts("-o", "FILE", "output file .csv, .png or .svg; may be repeated", outputs);
        line.number("--samples", "N", "number of samples (default 1000)", request.samples, 1, 1 << 24);
        line.number("--every", "N", "record one in N periods (default 1)", request.every, 1, 1000000);
        line.text("--thread", "NAME", "thread that records", thread);
        line.take("--trigger", 3, "NAME KIND LEVEL",
                  "trigger on NAME; KIND: rising, falling, either, above or below",
                  [this](const Words &words) { return take_trigger(request, words); });
        line.number("--pre", "PERCENT", "part of the record before the trigger (default 10)", pre_percent, 0,
                    99.9);
        line.number("--timeout", "S", "timeout (default 10)", timeout_s, 0, 1e6);
        line.flag("--force", "keep the incomplete record at the timeout", forced);
        line.rest(request.names);
        return line;
    }
    void finish() {
        const bool has_trigger = request.trigger != TriggerKind::NONE;
        request.pretrigger = (pre_percent >= 0 ? pre_percent : has_trigger ? 10.0 : 0.0) / 100.0;
    }
};

/// Waits for the end of the record; after the timeout it is forced or abandoned.
Result<> wait_for_record(Instance &hal, Capture &capture, const CaptureCommand &command,
                         volatile std::sig_atomic_t &stop) {
    constexpr double STEP_S = 0.01;
    double waited_s = 0;
    bool forced = false;
    while (capture.state() != CaptureState::DONE) {
        if (stop != 0) {
            return fail("stopped before the record was complete");
        }
        if (capture.state() == CaptureState::REFUSED) {
            return fail("the module capture rejected the settings");
        }
        if (waited_s > command.timeout_s && !hal.threads().isRunning()) {
            return fail("the threads are stopped", {}, "halcmd start starts them");
        }
        if (waited_s > command.timeout_s && capture.state() != CaptureState::TRIGGERED) {
            if (!command.forced || forced) {
                return fail(fmt::format("no trigger within {} s", command.timeout_s), {},
                            forced ? "is the thread running (halcmd start)?" : "--force records anyway");
            }
            capture.force();
            forced = true;
            waited_s = 0;
        }
        nap(STEP_S);
        waited_s += STEP_S;
    }
    return {};
}

Result<> capture(const CaptureCommand &command, volatile std::sig_atomic_t &stop) {
    const auto host = HostClient::connect(default_instance());
    if (!host) {
        return std::unexpected(host.error());
    }
    auto capture = Capture::open(**host, command.thread);
    if (!capture) {
        return std::unexpected(capture.error());
    }
    Result<> done = capture->begin(command.request);
    if (done) {
        done = wait_for_record((*host)->hal(), *capture, command, stop);
    }
    if (!done) {
        return done;
    }
    const auto record = capture->record();
    if (!record) {
        return std::unexpected(record.error());
    }
    for (const std::string &name : record->moved) {
        language::tell(fmt::format(
            "warning: '{}' was linked or unlinked during the recording; its values may be old", name));
    }
    if (command.outputs.empty()) {
        std::fputs(to_csv(*record).c_str(), stdout);
    }
    for (const std::string &path : command.outputs) {
        const Result<> written =
            write_record(*record, fmt::format("HAL capture, {} samples", record->times_s.size()), path);
        if (!written) {
            return written;
        }
    }
    return {};
}

// ---- graph, latency

struct GraphCommand {
    NetlistOptions options;
    std::string path;

    CommandLine line() {
        CommandLine line("millwright hal graph [options]",
                         "Draws components and signals. Dot text to standard output without -o.\n");
        line.text("-o", "FILE", "write .svg, .png, .pdf or .dot", path);
        line.text("--only", "GLOB", "only components and signals with such names", options.glob);
        line.flag("--values", "show values", options.showsValues);
        line.flag("--unlinked", "also show unlinked pins", options.showsUnlinked);
        return line;
    }
};

Result<> graph(const GraphCommand &command) {
    const auto host = HostClient::connect(default_instance());
    if (!host) {
        return std::unexpected(host.error());
    }
    if (command.path.empty()) {
        std::fputs(netlist_dot((*host)->hal(), command.options).c_str(), stdout);
        return {};
    }
    return write_netlist((*host)->hal(), command.options, command.path);
}

/// Threads with the two periods; a base period of 0 omits that thread.
std::vector<LatencyThread> threads_of(std::int64_t base_ns, std::int64_t servo_ns) {
    std::vector<LatencyThread> threads;
    if (base_ns > 0) {
        threads.push_back({"base", base_ns, 100});
    }
    threads.push_back({"servo", servo_ns, 1000});
    return threads;
}

struct LatencyCommand {
    LatencyOptions options;
    std::int64_t base_ns = 0, servo_ns = 1'000'000;
    std::string path;

    CommandLine line() {
        CommandLine line("millwright hal latency [options]",
                         "Measures the latency of threads in a separate realtime process.\n");
        take_period(line, "--base", "period of the base thread: 25us, 1ms or nanoseconds (default: none)",
                    base_ns);
        take_period(line, "--servo", "period of the servo thread (default 1ms)", servo_ns);
        line.number("--seconds", "S", "duration (default: until stopped)", options.seconds, 0.01, 1e7);
        line.text("-o", "FILE", "write .png, .svg or .csv", path);
        line.text("--text", "NOTE", "text in the image", options.note);
        return line;
    }
};

Result<> latency(LatencyCommand command, volatile std::sig_atomic_t &stop) {
    LatencyOptions &options = command.options;
    options.threads = threads_of(command.base_ns, command.servo_ns);
    options.showsBars = true;
    options.live = ::isatty(STDOUT_FILENO) != 0;
    (command.path.ends_with(".csv") ? options.csv_path : options.picture_path) = command.path;
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

/// Runs a command from its words; returns the exit status.
template <class Command, class Run>
int carry_out(const Words &words, const Run &run) {
    Command command;
    const CommandLine line = command.line();
    if (options::wantsHelp(words)) {
        std::fputs(line.help().c_str(), stdout);
        return 0;
    }
    const auto parsed = line.parse(words);
    return report(parsed ? run(command) : parsed);
}

}  // namespace

int command_hal(const Words &words, volatile std::sig_atomic_t &stop) {
    const std::string command = words.empty() ? "" : words[0];
    const Words rest(words.empty() ? words.begin() : words.begin() + 1, words.end());
    if (command == "watch") {
        return carry_out<WatchCommand>(rest, [&](WatchCommand &one) { return watch(one, stop); });
    }
    if (command == "capture") {
        return carry_out<CaptureCommand>(rest, [&](CaptureCommand &one) {
            one.finish();
            return capture(one, stop);
        });
    }
    if (command == "graph") {
        return carry_out<GraphCommand>(rest, [](GraphCommand &one) { return graph(one); });
    }
    if (command == "latency") {
        return carry_out<LatencyCommand>(rest, [&](LatencyCommand &one) { return latency(one, stop); });
    }
    if (options::wantsHelp(words) || command == "help") {
        std::fputs(language::shown(USAGE).c_str(), stdout);
        return 0;
    }
    if (!command.empty() && (command[0] == '-' || command.find('.') == std::string::npos)) {
        language::tell(
            fmt::format("millwright hal: unknown command '{}'; see millwright hal --help", command));
        return 2;
    }
    return report(live(words, stop));
}

int latency_test(const Words &words, volatile std::sig_atomic_t &stop) {
    LatencyOptions options;
    Words rest;
    CommandLine line(
        "latency-test [base-period [servo-period]] [options]",
        "Periods as 25us, 1ms or nanoseconds; base-period 0: servo thread only. Default: 25us 1ms\n");
    line.number("--seconds", "S", "duration (default: until stopped)", options.seconds, 0.01, 1e7);
    line.text("-o", "FILE", "write .png or .svg", options.picture_path);
    line.rest(rest);
    if (options::wantsHelp(words)) {
        std::fputs(line.help().c_str(), stdout);
        return 0;
    }
    std::int64_t periods[2] = {25'000, 1'000'000};
    Result<> done = line.parse(words);
    for (std::size_t i = 0; done && i < rest.size(); ++i) {
        if (i == 0 && rest[0] == "0") {
            periods[0] = 0;
            continue;
        }
        const auto period = i < 2 ? parse_period(rest[i]) : fail("latency-test accepts at most two periods");
        done = period ? Result<>{} : std::unexpected(period.error());
        periods[i < 2 ? i : 0] = period.value_or(0);
    }
    if (done) {
        options.threads = threads_of(periods[0], periods[1]);
        options.live = ::isatty(STDOUT_FILENO) != 0;
        done = run_latency(options, stop);
    }
    return report(done, "latency-test");
}

namespace {

struct HistogramCommand {
    LatencyOptions options;
    std::int64_t base_ns = 25'000, servo_ns = 1'000'000;
    int base_bin_ns = 100, servo_bin_ns = 100;
    double without_effect = 0;
    bool has_no_base = false, ignored = false, wants_help = false;

    CommandLine line() {
        CommandLine line("latency-histogram [options]",
                         "Prints histograms at the end (Ctrl-C, or after S seconds).\n");
        take_period(line, "--base", "period of the base thread [ns] (default 25000)", base_ns);
        take_period(line, "--servo", "period of the servo thread [ns] (default 1000000)", servo_ns);
        line.flag("--nobase", "servo thread only", has_no_base);
        line.number("--bbinsize", "NS", "bin size of the base thread (default 100)", base_bin_ns, 1, 1000000);
        line.number("--sbinsize", "NS", "bin size of the servo thread (default 100)", servo_bin_ns, 1,
                    1000000);
        line.text("--text", "NOTE", "text in the image", options.note);
        line.number("--seconds", "S", "duration (default: until stopped)", options.seconds, 0.01, 1e7);
        line.text("-o", "FILE", "write .png or .svg", options.picture_path);
        line.text("--csv", "FILE", "write the counts", options.csv_path);
        line.number("--bbins", "N", "", without_effect, 1, 1e6);
        line.number("--sbins", "N", "", without_effect, 1, 1e6);
        line.number("--logscale", "N", "", without_effect, 0, 1);
        line.flag("--show", "", ignored);
        line.flag("--verbose", "", ignored);
        line.flag("--nox", "", ignored);
        line.flag("-?", "", wants_help);
        line.footer("--bbins, --sbins, --logscale, --show, --verbose and --nox are accepted without effect: "
                    "all bins are\ncounted and shown.\n");
        return line;
    }
};

}  // namespace

int latency_histogram(const Words &words, volatile std::sig_atomic_t &stop) {
    HistogramCommand command;
    const CommandLine line = command.line();
    Result<> done = line.parse(words);
    if (options::wantsHelp(words) || (done && command.wants_help)) {
        std::fputs(line.help().c_str(), stdout);
        return 0;
    }
    LatencyOptions &options = command.options;
    if (done) {
        if (command.ignored || command.without_effect > 0) {
            language::tell(
                "latency-histogram: --bbins, --sbins, --logscale, --show, --verbose and --nox have no "
                "effect: all bins are counted and shown");
        }
        options.threads = threads_of(command.has_no_base ? 0 : command.base_ns, command.servo_ns);
        options.threads.back().bin_ns = command.servo_bin_ns;
        if (!command.has_no_base) {
            options.threads.front().bin_ns = command.base_bin_ns;
        }
        options.showsBars = true;
        options.live = ::isatty(STDOUT_FILENO) != 0;
        done = run_latency(options, stop);
    }
    return report(done, "latency-histogram");
}

}  // namespace mw::hal::view
