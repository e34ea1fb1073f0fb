// SPDX-License-Identifier: GPL-2.0-or-later
// Time of a message of 200 bytes through a buffer: median and 99.9th percentile of each access, in
// nanoseconds.
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "base/diagnostics/sink.hh"
#include "clients/nml/config/config_file.hh"
#include "clients/nml/message/codec.hh"
#include "clients/nml/net/remote_buffer.hh"
#include "clients/nml/net/server.hh"

namespace mw::nml {
namespace {

const std::string MESSAGE(200, 'x');

Config perf_config(const std::string &options) {
    diagnostics::Sink sink;
    Config config =
        parse_config("B b SHMEM 127.0.0.1 8192 0 0 1 8 901 " + options +
                         "\nP m b LOCAL 127.0.0.1 RW 1 1.0 1 0\nP p b LOCAL 127.0.0.1 RW 0 1.0 0 1\n"
                         "P r b REMOTE 127.0.0.1 RW 0 1.0 0 2\n",
                     "perf.nml", sink);
    return config;
}

void tell(benchmark::State &state, const char *what, std::vector<std::int64_t> &times) {
    if (times.empty()) {
        return;
    }
    std::sort(times.begin(), times.end());
    state.counters[std::string(what) + "_median_ns"] = static_cast<double>(times[times.size() / 2]);
    state.counters[std::string(what) + "_p99.9_ns"] = static_cast<double>(times[times.size() * 999 / 1000]);
}

/// Writes and reads in this process. With `isShared` another process also reads continuously.
void measure(benchmark::State &state, const std::string &options, bool shared) {
    const Config config = perf_config(options);
    LocalPlaces local;
    const std::string instance = "perf" + std::to_string(::getpid());
    const auto master = open_buffer(config.buffers[0], config.processes[0], instance, local);
    if (!master.has_value()) {
        state.SkipWithError(master.error().str().c_str());
        return;
    }
    const pid_t pid = shared ? ::fork() : -1;
    if (pid == 0) {
        ::prctl(PR_SET_PDEATHSIG, SIGKILL);
        LocalPlaces places;
        const auto peer = open_buffer(config.buffers[0], config.processes[1], instance, places);
        Received received;
        while (peer.has_value() && (*peer)->peek(received, FOREVER).has_value()) {
        }
        ::_exit(1);
    }
    std::vector<std::int64_t> writes, reads;
    Received received;
    for (auto _ : state) {
        const std::int64_t begin = monotonic_ns();
        const auto written = (*master)->write(MESSAGE, FOREVER);
        const std::int64_t middle = monotonic_ns();
        const auto read = (*master)->read(received, FOREVER);
        const std::int64_t end = monotonic_ns();
        if (!written.has_value() || !read.has_value() || !*read) {
            state.SkipWithError("the message did not come");
            break;
        }
        writes.push_back(middle - begin);
        reads.push_back(end - middle);
    }
    if (pid > 0) {
        ::kill(pid, SIGKILL);
        ::waitpid(pid, nullptr, 0);
    }
    tell(state, "write", writes);
    tell(state, "read", reads);
}

void over_tcp(benchmark::State &state) {
    Config config = perf_config("TCP=1");
    config.buffers[0].tcp_port = 0;
    LocalPlaces local;
    const Vocabulary vocabulary = Vocabulary::standard();
    const std::string instance = "perftcp" + std::to_string(::getpid());
    const auto master = open_buffer(config.buffers[0], config.processes[0], instance, local);
    const auto server = Server::start(config, "m", instance, vocabulary, local);
    if (!master.has_value() || !server.has_value()) {
        state.SkipWithError("no server");
        return;
    }
    config.buffers[0].tcp_port = (*server)->tcp_port();
    const auto client = open_remote_buffer(config.buffers[0], config.processes[2]);
    std::vector<std::int64_t> reads;
    Received received;
    static_cast<void>((*master)->write(MESSAGE, FOREVER));
    for (auto _ : state) {
        const std::int64_t begin = monotonic_ns();
        const auto read = (*client)->peek(received, FOREVER);
        reads.push_back(monotonic_ns() - begin);
        if (!read.has_value() || !*read) {
            state.SkipWithError("the message did not come");
            break;
        }
    }
    tell(state, "read", reads);
}

BENCHMARK_CAPTURE(measure, one_process_os_sem, "mutex=os_sem", false)->Iterations(200000);
BENCHMARK_CAPTURE(measure, one_process_mao, "mutex=mao split=4", false)->Iterations(200000);
BENCHMARK_CAPTURE(measure, one_process_queue, "queue", false)->Iterations(200000);
BENCHMARK_CAPTURE(measure, two_processes_os_sem, "mutex=os_sem", true)->Iterations(200000);
BENCHMARK_CAPTURE(measure, two_processes_mao, "mutex=mao split=4", true)->Iterations(200000);
BENCHMARK(over_tcp)->Iterations(5000);

}  // namespace
}  // namespace mw::nml
