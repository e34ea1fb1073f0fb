// SPDX-License-Identifier: GPL-2.0-or-later
// The processor time of a cycle of the driver with its bus, without the wait for the board. It includes read
// and write of all pins, the request, the check of the answer and the write packet. The answers are those of
// the last cycle of the simulated board before the measurement, with the expected numbers.
#include <chrono>
#include <memory>
#include <string>

#include <benchmark/benchmark.h>

#include "drivers/mesa/board/board_transport.hh"
#include "drivers/mesa/ethernet/ethernet_bus.hh"
#include "drivers/mesa/hostmot2/board.hh"
#include "drivers/mesa/hostmot2/test/board_fixture.hh"
#include "drivers/mesa/identity/idrom.hh"

namespace mw::mesa {
namespace {

constexpr long PERIOD_NS = 1'000'000;
constexpr int CYCLES_BEFORE = 200;  // smart serial has started after 10 ms

/// Packets of a driver.
struct Packets {
    std::int64_t requests = 0, answers = 0, writes = 0, request_bytes = 0, answer_bytes = 0, write_bytes = 0;
};

/// Connects to the simulated board first, then repeats its last answer.
class RecordedTransport final : public lbp16::Transport {
  public:
    explicit RecordedTransport(std::unique_ptr<board::BoardTransport> live) : live_(std::move(live)) {}

    void replay() {
        replays_ = true;
        packets_ = {};
    }
    board::BoardTransport &live() { return *live_; }
    const Packets &packets() const { return packets_; }

    lbp16::TransportResult send(std::span<const std::byte> packet) noexcept override {
        constexpr std::size_t NUMBER_AND_READ = 8, NUMBER = 4, WRITE_NUMBER_IN_ANSWER = 12;
        const bool isWrite = (std::to_integer<unsigned>(packet[1]) & 0x80U) != 0;
        if (isWrite) {
            std::ranges::copy(packet.last(NUMBER), last_write_.begin());
            ++packets_.writes;
            packets_.write_bytes += static_cast<std::int64_t>(packet.size());
        } else {
            ++packets_.requests;
            packets_.request_bytes += static_cast<std::int64_t>(packet.size());
        }
        if (!replays_) {
            return live_->send(packet);
        }
        if (!isWrite) {
            std::ranges::copy(packet.subspan(packet.size() - NUMBER_AND_READ, NUMBER),
                              answer_.begin() + static_cast<long>(size_ - HostNumbers::ANSWER_BYTES));
            std::ranges::copy(last_write_,
                              answer_.begin() + static_cast<long>(size_ - WRITE_NUMBER_IN_ANSWER));
            is_answer_due_ = true;
        }
        return {.bytes = packet.size(), .time_ns = now_ns()};
    }
    lbp16::TransportResult receive(std::span<std::byte> packet) noexcept override {
        if (!replays_) {
            const auto result = live_->receive(packet);
            if (result.isDone()) {
                size_ = result.bytes;
                std::copy_n(packet.begin(), size_, answer_.begin());
            }
            return result;
        }
        if (!std::exchange(is_answer_due_, false)) {
            return {.error = EAGAIN, .time_ns = now_ns()};
        }
        std::copy_n(answer_.begin(), size_, packet.begin());
        ++packets_.answers;
        packets_.answer_bytes += static_cast<std::int64_t>(size_);
        return {.bytes = size_, .time_ns = now_ns()};
    }
    void wait_until(std::int64_t deadline_ns) noexcept override {
        if (!replays_) {
            live_->wait_until(deadline_ns);
        }
    }
    std::int64_t now_ns() const noexcept override {
        return replays_ ? std::chrono::steady_clock::now().time_since_epoch().count() : live_->now_ns();
    }

  private:
    std::unique_ptr<board::BoardTransport> live_;
    std::array<std::byte, lbp16::MAX_PACKET_BYTES> answer_{};
    std::array<std::byte, 4> last_write_{};
    std::size_t size_ = 0;
    bool replays_ = false, is_answer_due_ = false;
    Packets packets_;
};

/// A board and its driver in operation.
class Driven {
  public:
    Driven(const std::string &model, const std::string &physics, const std::string &config)
        : model_(*board::load_model(model)),
          board_(model_, *board::parse_physics(physics, "physics", model_.idrom)), link_(board_, {}) {
        auto made = std::make_unique<RecordedTransport>(std::make_unique<board::BoardTransport>(link_));
        transport_ = made.get();
        bus_ = std::move(*EthernetBus::open(std::move(made), "board"));
        const auto idrom = decode_idrom([&](std::uint16_t address, int count) {
            return bus_->read_now({.address = address, .count = static_cast<std::uint16_t>(count)});
        });
        driver_ = std::move(*Board::make(*bus_, *idrom, *parse_config(config)));
        driver_->declare(pins_);
        move_all();
        for (int i = 1; i <= CYCLES_BEFORE; ++i) {
            transport_->live().sleep_until(transport_->now_ns() + PERIOD_NS);
            cycle();
        }
        transport_->replay();
    }
    void request() { driver_->request(); }
    void cycle() {
        driver_->read(PERIOD_NS, transport_->now_ns());
        driver_->write(PERIOD_NS, transport_->now_ns());
    }
    bool isGood() const { return bus_->errors().total() == 0; }
    const Packets &packets() const { return transport_->packets(); }

  private:
    void move_all() {
        for (auto &[name, pin] : pins_.pins) {
            if (name.ends_with(".enable")) {
                pins_.set(name, 1);
            }
            if (name.ends_with(".velocity-cmd") || name.ends_with(".control-type")) {
                pins_.set(name, 1);
            }
        }
    }

    board::Model model_;
    board::Board board_;
    board::Link link_;
    RecordedTransport *transport_ = nullptr;
    std::unique_ptr<EthernetBus> bus_;
    std::unique_ptr<Board> driver_;
    test::PinMap pins_;
};

void report(benchmark::State &state, const Driven &driven) {
    const auto cycles = static_cast<double>(state.iterations());
    const Packets &packets = driven.packets();
    state.counters["requests"] = static_cast<double>(packets.requests) / cycles;
    state.counters["answers"] = static_cast<double>(packets.answers) / cycles;
    state.counters["writes"] = static_cast<double>(packets.writes) / cycles;
    state.counters["request_B"] = static_cast<double>(packets.request_bytes) / cycles;
    state.counters["answer_B"] = static_cast<double>(packets.answer_bytes) / cycles;
    state.counters["write_B"] = static_cast<double>(packets.write_bytes) / cycles;
    if (!driven.isGood()) {
        state.SkipWithError("cycles have failed");
    }
}

void BM_Cycle(benchmark::State &state, const char *model, const char *physics, const char *config) {
    Driven driven(model, physics, config);
    for (auto _ : state) {
        driven.cycle();
    }
    report(state, driven);
}
BENCHMARK_CAPTURE(BM_Cycle, 7i76e_5_stepgens_encoder_7i76, "7i76e", "remote 0 card=7i76\n",
                  "num_stepgens=5 num_encoders=1 sserial_port_0=0xxxxxxx");
BENCHMARK_CAPTURE(BM_Cycle, 7i76e_without_smart_serial, "7i76e", "", "num_stepgens=5 num_encoders=1");
BENCHMARK_CAPTURE(BM_Cycle, 7i76e_with_7i76_and_7i84, "7i76e", "remote 0 card=7i76\nremote 1 card=7i84\n",
                  "sserial_port_0=20xxxxxx");
BENCHMARK_CAPTURE(BM_Cycle, 7i92, "7i92", "", "");
BENCHMARK_CAPTURE(BM_Cycle, 7i95, "7i95", "", "");
BENCHMARK_CAPTURE(BM_Cycle, 7i97, "7i97", "", "");
BENCHMARK_CAPTURE(BM_Cycle, 7i80hd_3pwm, "7i80hd-3pwm", "", "");

/// Like a thread that first calls `read-request` of both boards.
void BM_TwoBoards(benchmark::State &state) {
    Driven one("7i76e", "remote 0 card=7i76\n", "num_stepgens=5 num_encoders=1 sserial_port_0=0xxxxxxx");
    Driven two("7i76e", "remote 0 card=7i76\n", "num_stepgens=5 num_encoders=1 sserial_port_0=0xxxxxxx");
    for (auto _ : state) {
        one.request();
        two.request();
        one.cycle();
        two.cycle();
    }
    report(state, two);
}
BENCHMARK(BM_TwoBoards);

}  // namespace
}  // namespace mw::mesa
