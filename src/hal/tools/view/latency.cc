// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/tools/view/latency.hh"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>

#include <fmt/format.h>

#include "base/atomic_file.hh"
#include "base/charts/chart.hh"
#include "base/duration.hh"
#include "base/language/language.hh"
#include "base/text.hh"
#include "hal/host/host_client.hh"

namespace mw::hal::view {

namespace {

void nap(double seconds) {
    const std::int64_t ns = to_ns(seconds);
    const timespec pause{ns / NS_PER_SECOND, ns % NS_PER_SECOND};
    nanosleep(&pause, nullptr);  // a signal ends it early
}

LatencyFigures figures_of(const LatencyThread &thread, const LatencySlot &slot) {
    LatencyFigures f;
    f.name = thread.name;
    f.period_ns = slot.period_ns.load();
    f.bin_ns = slot.bin_ns.load();
    f.intervals = slot.intervals.load(std::memory_order_acquire);
    f.below = slot.below.load();
    f.above = slot.above.load();
    f.last_ns = slot.last_ns.load();
    f.min_ns = slot.min_ns.load();
    f.max_ns = slot.max_ns.load();
    const auto n = static_cast<double>(std::max<std::uint64_t>(f.intervals, 1));
    f.mean_ns = slot.sum_ns.load() / n;
    f.deviation_ns = std::sqrt(std::max(0.0, slot.sum_squares_ns2.load() / n - f.mean_ns * f.mean_ns));
    f.bins.reserve(LATENCY_BINS);
    for (const auto &bin : slot.bins) {
        f.bins.push_back(bin.load());
    }
    return f;
}

struct Span {
    std::size_t first, last;
};

/// The range of bins with counts, or the middle bins when there are no counts.
Span met(const LatencyFigures &f) {
    Span span{f.bins.size() / 2, f.bins.size() / 2};
    bool first = true;
    for (std::size_t i = 0; i < f.bins.size(); ++i) {
        if (f.bins[i] > 0) {
            span = {first ? i : span.first, i};
            first = false;
        }
    }
    return span;
}

double deviation_us(const LatencyFigures &f, std::size_t bin) {
    return (static_cast<double>(bin) - LATENCY_BINS / 2.0) * static_cast<double>(f.bin_ns) * 1e-3;
}

Result<> write_csv(const std::vector<LatencyFigures> &figures, const std::string &path) {
    std::string text = "thread,deviation_ns,count\n";
    for (const LatencyFigures &f : figures) {
        for (std::size_t i = 0; i < f.bins.size(); ++i) {
            if (f.bins[i] > 0) {
                text += fmt::format("{},{},{}\n", f.name,
                                    (static_cast<std::int64_t>(i) - LATENCY_BINS / 2) * f.bin_ns, f.bins[i]);
            }
        }
    }
    return write_file_atomically(path, text);
}

/// Shows the table each second until the time is over or a signal arrives.
Result<std::vector<LatencyFigures>> watch(Instance &hal, const LatencyOptions &options,
                                          volatile std::sig_atomic_t &stop) {
    const double step_s = options.seconds > 0 ? std::min(1.0, options.seconds) : 1.0;
    bool shown = false;
    for (double passed = 0; stop == 0 && (options.seconds <= 0 || passed < options.seconds);
         passed += step_s) {
        nap(step_s);
        const auto figures = read_latency(hal, options.threads);
        if (!figures) {
            return figures;
        }
        if (options.live) {
            if (shown) {
                std::printf("\033[%zuA", figures->size() + 1);
            }
            std::fputs(latency_table(*figures).c_str(), stdout);
            std::fflush(stdout);
            shown = true;
        }
    }
    return read_latency(hal, options.threads);
}

Result<> report(const std::vector<LatencyFigures> &figures, const LatencyOptions &options) {
    if (!options.live) {
        std::fputs(latency_table(figures).c_str(), stdout);
    }
    for (const LatencyFigures &f : figures) {
        if (options.showsBars) {
            std::printf("\n%s", latency_bars(f).c_str());
        }
    }
    if (!options.csv_path.empty()) {
        const Result<> written = write_csv(figures, options.csv_path);
        if (!written) {
            return written;
        }
    }
    return options.picture_path.empty() ? Result<>{}
                                        : draw_latency(figures, options.note, options.picture_path);
}

}  // namespace

std::int64_t LatencyFigures::jitter_ns() const noexcept {
    return intervals == 0 ? 0 : std::max(period_ns - min_ns, max_ns - period_ns);
}

Result<std::int64_t> parse_period(const std::string &text) {
    const std::size_t unit_at = text.find_first_of("nums");
    const std::string unit = unit_at == std::string::npos ? "ns" : text.substr(unit_at);
    const auto number = parse_double(text.substr(0, unit_at));
    const double factor = unit == "ns" ? 1 : unit == "us" ? 1e3 : unit == "ms" ? 1e6 : unit == "s" ? 1e9 : 0;
    constexpr double LEAST = 1000, MOST = 1e9;
    if (!number || factor == 0 || !(*number * factor >= LEAST && *number * factor <= MOST)) {
        return fail(fmt::format("'{}' is not a period", text), {},
                    "write 25us, 1ms or nanoseconds, 1 us to 1 s");
    }
    return std::llround(*number * factor);
}

Result<> start_latency(Host &host, const std::vector<LatencyThread> &threads) {
    std::vector<std::string> thread_args;
    std::string bins;
    for (std::size_t i = 0; i < threads.size(); ++i) {
        thread_args.push_back(fmt::format("name{}={}", i + 1, threads[i].name));
        thread_args.push_back(fmt::format("period{}={}", i + 1, threads[i].period_ns));
        bins += fmt::format("{}{}", i == 0 ? "" : ",", threads[i].bin_ns);
    }
    Result<> done = host.load_realtime("threads", thread_args);
    if (done) {
        done = host.load_realtime("latency", {fmt::format("count={}", threads.size()), "bin=" + bins});
    }
    for (std::size_t i = 0; done && i < threads.size(); ++i) {
        done = host.hal().threads().add_function(fmt::format("latency.{}", i), threads[i].name);
    }
    return done ? host.hal().threads().start() : done;
}

Result<std::vector<LatencyFigures>> read_latency(Instance &hal, const std::vector<LatencyThread> &threads) {
    const auto memory = hal.memory().shared_block(LATENCY_KEY, sizeof(LatencyBlock));
    if (!memory) {
        return std::unexpected(memory.error());
    }
    const auto &block = *static_cast<const LatencyBlock *>(*memory);
    if (block.magic != LATENCY_MAGIC) {
        return fail("the module latency is of another version");
    }
    std::vector<LatencyFigures> all;
    for (std::size_t i = 0; i < threads.size(); ++i) {
        all.push_back(figures_of(threads[i], block.slots[i]));
    }
    return all;
}

std::string latency_table(const std::vector<LatencyFigures> &figures) {
    std::string text =
        fmt::format("{:<8} {:>10} {:>11} {:>11} {:>11} {:>11} {:>9} {:>12}\n", "thread", "period ns",
                    "last ns", "min ns", "max ns", "jitter ns", "sdev ns", "intervals");
    for (const LatencyFigures &f : figures) {
        text += fmt::format("{:<8} {:>10} {:>11} {:>11} {:>11} {:>11} {:>9.0f} {:>12}\n", f.name, f.period_ns,
                            f.last_ns, f.min_ns, f.max_ns, f.jitter_ns(), f.deviation_ns, f.intervals);
    }
    return text;
}

std::string latency_bars(const LatencyFigures &f, int rows, int columns) {
    const Span span = met(f);
    const std::size_t width = (span.last - span.first) / static_cast<std::size_t>(rows) + 1;
    std::vector<std::uint64_t> joined;
    for (std::size_t i = span.first; i <= span.last; i += width) {
        std::uint64_t sum = 0;
        for (std::size_t k = i; k < std::min(i + width, span.last + 1); ++k) {
            sum += f.bins[k];
        }
        joined.push_back(sum);
    }
    const double most =
        std::log10(1.0 + static_cast<double>(*std::max_element(joined.begin(), joined.end())));
    std::string text =
        fmt::format("{}: intervals by deviation from {} ns (bars: logarithm)\n", f.name, f.period_ns);
    for (std::size_t i = 0; i < joined.size(); ++i) {
        const double part = most > 0 ? std::log10(1.0 + static_cast<double>(joined[i])) / most : 0.0;
        text += fmt::format("{:>10.1f} us {:>12} {}\n", deviation_us(f, span.first + i * width), joined[i],
                            std::string(static_cast<std::size_t>(std::lround(part * columns)), '#'));
    }
    if (f.below + f.above > 0) {
        text += fmt::format("outside of the bins: {} below, {} above\n", f.below, f.above);
    }
    return text;
}

Result<> draw_latency(const std::vector<LatencyFigures> &figures, const std::string &note,
                      const std::string &path) {
    std::vector<charts::Histogram> histograms;
    for (const LatencyFigures &f : figures) {
        const Span span = met(f);
        charts::Histogram h;
        h.title = fmt::format(
            "{}: period {} us, {} intervals, jitter {:.1f} us, standard deviation {:.1f} us{}{}", f.name,
            static_cast<double>(f.period_ns) * 1e-3, f.intervals, static_cast<double>(f.jitter_ns()) * 1e-3,
            f.deviation_ns * 1e-3, note.empty() ? "" : "; ", note);
        h.first = deviation_us(f, span.first);
        h.bin_width = static_cast<double>(f.bin_ns) * 1e-3;
        h.unit = "deviation from the period [us]";
        h.counts.assign(f.bins.begin() + static_cast<std::ptrdiff_t>(span.first),
                        f.bins.begin() + static_cast<std::ptrdiff_t>(span.last) + 1);
        h.below = static_cast<double>(f.below);
        h.above = static_cast<double>(f.above);
        histograms.push_back(std::move(h));
    }
    return charts::draw_histograms(histograms, path);
}

Result<> run_latency(const LatencyOptions &options, volatile std::sig_atomic_t &stop) {
    auto host = HostClient::start(fmt::format("latency-{}", ::getpid()));
    if (!host) {
        return std::unexpected(host.error());
    }
    Result<> done = (*host)->control();
    if (done) {
        const std::string missing = (*host)->hal().host_status().realtime_missing();
        if (!missing.empty()) {
            language::tell("no realtime priority: " + missing);
        }
        done = start_latency(**host, options.threads);
    }
    if (done) {
        const auto figures = watch((*host)->hal(), options, stop);
        done = figures ? report(*figures, options) : std::unexpected(figures.error());
    }
    const Result<> ended = (*host)->shut_down();
    return done ? ended : done;
}

}  // namespace mw::hal::view
