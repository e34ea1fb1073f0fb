// SPDX-License-Identifier: GPL-2.0-or-later
// Packets of any bytes at the simulated board, and damaged answers at the Ethernet bus of the driver.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>

#include "drivers/mesa/board/board_transport.hh"
#include "drivers/mesa/board/model.hh"
#include "drivers/mesa/ethernet/ethernet_bus.hh"

namespace {

using namespace mw::mesa;

const board::Model &model() {
    static const board::Model the_model = *board::load_model("7i76e");
    return the_model;
}

void send_to_board(std::span<const std::uint8_t> data) {
    board::Board simulated(model());
    std::int64_t time_ns = 0;
    while (!data.empty()) {
        const std::size_t size = std::min<std::size_t>(data[0], data.size() - 1);
        const auto packet = std::as_bytes(data.subspan(1, size));
        const auto reply = simulated.execute(packet, time_ns += 1'000'000);
        if (reply && reply->time_ns > time_ns) {
            time_ns = std::min(reply->time_ns, time_ns + 1'000'000'000);
        }
        data = data.subspan(1 + size);
    }
}

/// Damages answers as soon as `data` is set.
class DamagingTransport final : public lbp16::Transport {
  public:
    explicit DamagingTransport(board::Link &link) : inner_(link) {}

    lbp16::TransportResult send(std::span<const std::byte> packet) noexcept override {
        return inner_.send(packet);
    }
    lbp16::TransportResult receive(std::span<std::byte> packet) noexcept override {
        lbp16::TransportResult result = inner_.receive(packet);
        if (!result.isDone() || data.size() < 4) {
            return result;
        }
        // Two bytes select the position, one the change, one the number of bytes that are left.
        const std::size_t at = (data[0] + 256U * data[1]) % std::max<std::size_t>(result.bytes, 1);
        packet[at] ^= std::byte{data[2]};
        if ((data[3] & 0x80U) != 0) {
            result.bytes = std::min<std::size_t>(result.bytes, 4U * (data[3] & 0x7FU));
        }
        data = data.subspan(4);
        return result;
    }
    void wait_until(std::int64_t deadline_ns) noexcept override { inner_.wait_until(deadline_ns); }
    std::int64_t now_ns() const noexcept override { return inner_.now_ns(); }
    void sleep_until(std::int64_t time_ns) { inner_.sleep_until(time_ns); }

    std::span<const std::uint8_t> data;

  private:
    board::BoardTransport inner_;
};

void answer_driver(std::span<const std::uint8_t> data) {
    board::Board simulated(model());
    board::Link link(simulated, {});
    auto made = std::make_unique<DamagingTransport>(link);
    DamagingTransport *const transport = made.get();
    const bool early = !data.empty() && (data[0] & 1U) != 0;
    data = data.subspan(std::min<std::size_t>(1, data.size()));
    if (early) {
        transport->data = data;
    }
    auto bus = EthernetBus::open(std::move(made), "board");
    if (!bus) {
        return;
    }
    const std::array<RegisterRange, 2> ranges{{{0x1000, 3}, {0x2100, 5}}};
    if (!(*bus)->set_lists(ranges, 10)) {
        return;
    }
    if (!early) {
        transport->data = data;
    }
    std::array<std::uint32_t, 8> values{};
    std::int64_t next_ns = transport->now_ns();
    for (int cycle = 0; cycle < 100; ++cycle) {
        constexpr long PERIOD_NS = 1'000'000;
        transport->sleep_until(next_ns += PERIOD_NS);
        const CycleRead read = (*bus)->read(values, PERIOD_NS);
        if (read == CycleRead::STOPPED) {
            (*bus)->resume();
        }
        const RegisterWrite write{0x0E00, 0x5A000000};
        (void)(*bus)->write(std::span(&write, 1));
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    const std::span<const std::uint8_t> input(data, size);
    if (!input.empty() && (input[0] & 1U) != 0) {
        send_to_board(input.subspan(1));
    } else if (!input.empty()) {
        answer_driver(input.subspan(1));
    }
    return 0;
}
