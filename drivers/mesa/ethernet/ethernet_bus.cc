// SPDX-License-Identifier: GPL-2.0-or-later
// The functions of the Ethernet bus that the servo thread runs.
#include "drivers/mesa/ethernet/ethernet_bus.hh"

#include <algorithm>
#include <cerrno>

namespace mw::mesa {

namespace {

using lbp16::PacketWriter;

constexpr std::size_t BOARD_PACKETS_BYTES = 2;

/// Maximum number of packets that a cycle reads; more packets can only be a flood of old ones.
constexpr int MAX_RECEIVED = 64;
/// Maximum number of registers at consecutive addresses that one command writes.
constexpr std::size_t MAX_BLOCK = 64;

/// Number of writes from the first one on that have consecutive addresses.
std::size_t block_of(std::span<const RegisterWrite> writes) noexcept {
    std::size_t count = 1;
    while (count < std::min(writes.size(), MAX_BLOCK) &&
           writes[count].address == static_cast<std::uint16_t>(writes[count - 1].address + 4)) {
        ++count;
    }
    return count;
}

/// The bytes of a command that writes `count` registers.
constexpr std::size_t block_bytes(std::size_t count) noexcept {
    return 4 + 4 * count;
}

void append_block(PacketWriter &packet, std::span<const RegisterWrite> block) noexcept {
    std::array<std::byte, 4 * MAX_BLOCK> data{};
    for (std::size_t i = 0; i < block.size(); ++i) {
        std::ranges::copy(lbp16::bytes_of_number(block[i].value),
                          data.begin() + static_cast<std::ptrdiff_t>(4 * i));
    }
    packet.write(
        {.writes = true, .units = static_cast<std::uint8_t>(block.size()), .address = block[0].address},
        std::span(data).first(4 * block.size()));
}

}  // namespace

void EthernetBus::request() noexcept {
    if (link_ == Link::STOPPED || requested_) {
        return;
    }
    Request &request = link_ == Link::COMPARING ? identity_ : cyclic_;
    const std::span<const std::byte> packet = numbers_.number(request.packet);
    CycleTimes &cycle = log_.next();
    cycle.begin_ns = transport_->now_ns();
    cycle.host_packets = ++host_packets_;
    cycle.number = numbers_.last_request();
    const lbp16::TransportResult sent = transport_->send(packet);
    cycle.sent_ns = sent.time_ns;
    cycle.error = sent.error;
    requested_ = true;
}

CycleRead EthernetBus::read(std::span<std::uint32_t> values, long period_ns) noexcept {
    if (link_ == Link::STOPPED) {
        return CycleRead::STOPPED;
    }
    request();
    requested_ = false;
    CycleTimes &cycle = log_.last();
    log_.set_period(period_ns);
    const std::int64_t deadline_ns = cycle.begin_ns + read_timeout_ns(settings.read_timeout, period_ns);
    cycle.outcome = cycle.error != 0 ? CycleOutcome::SEND_FAILED : wait_for_answer(deadline_ns, cycle);
    const bool answered = cycle.outcome == CycleOutcome::DONE || cycle.outcome == CycleOutcome::WRITE_LOST;
    const bool comparing = link_ == Link::COMPARING;
    count(cycle.outcome);
    if (answered && !comparing) {
        cycle.board_packets = lbp16::number_at<std::uint16_t>(
            std::span(answer_).subspan(cyclic_.data_bytes - BOARD_PACKETS_BYTES));
    }
    if (answered && comparing) {
        numbers_.accept(std::span(answer_).subspan(identity_.data_bytes, HostNumbers::ANSWER_BYTES));
        link_ = Link::RUNNING;
        rewriting_ = true;
    }
    if (cycle.outcome == CycleOutcome::OTHER_BOARD || errors_.isExceeded()) {
        stop();
        log_.keep(errors_.isExceeded() ? BoardFault::STOPPED : BoardFault::OTHER_BOARD, transport_->now_ns());
    }
    if (link_ == Link::STOPPED) {
        return CycleRead::STOPPED;
    }
    if (!answered || comparing) {
        return CycleRead::FAILED;
    }
    for (std::size_t i = 0; i < std::min(values.size(), cyclic_.data_bytes / 4); ++i) {
        values[i] = lbp16::number_at<std::uint32_t>(std::span(answer_).subspan(4 * i));
    }
    return CycleRead::DONE;
}

CycleOutcome EthernetBus::wait_for_answer(std::int64_t deadline_ns, CycleTimes &cycle) noexcept {
    CycleOutcome failure = CycleOutcome::NO_ANSWER;
    for (int received = 0; received < MAX_RECEIVED; ++received) {
        const lbp16::TransportResult result = transport_->receive(answer_);
        if (result.isDone()) {
            cycle.answered_ns = result.time_ns;
            const Request &request = current();
            if (result.bytes != request.data_bytes + HostNumbers::ANSWER_BYTES) {
                failure = CycleOutcome::SHORT_ANSWER;
            } else if (!numbers_.isOfLastRequest(std::span(answer_).subspan(request.data_bytes))) {
                ++cycle.stale;
            } else {
                return outcome_of_answer();
            }
            continue;
        }
        if (result.error != EAGAIN) {
            failure = CycleOutcome::RECEIVE_FAILED;
            cycle.error = result.error;
        }
        if (result.time_ns >= deadline_ns) {
            break;
        }
        transport_->wait_until(deadline_ns);
    }
    cycle.answered_ns = 0;
    return failure;
}

/// Result of an answer to the last request.
CycleOutcome EthernetBus::outcome_of_answer() noexcept {
    const std::span<const std::byte> numbers = std::span(answer_).subspan(current().data_bytes);
    const bool isRestart = numbers_.take_restart(numbers);
    restarted_ = restarted_ || isRestart;
    if (link_ == Link::COMPARING) {
        const bool same = std::equal(known_identity_.begin(), known_identity_.end(), answer_.begin());
        return same ? CycleOutcome::DONE : CycleOutcome::OTHER_BOARD;
    }
    const bool written = numbers_.hasAllWrites(numbers);
    if (isRestart) {
        numbers_.accept(numbers);  // no former write is missing after this, because all registers are written
    }
    return written ? CycleOutcome::DONE : CycleOutcome::WRITE_LOST;
}

void EthernetBus::count(CycleOutcome outcome) noexcept {
    switch (outcome) {
    case CycleOutcome::DONE: break;
    case CycleOutcome::NO_ANSWER: ++counters_.no_answer; break;
    case CycleOutcome::SEND_FAILED: ++counters_.send_failed; break;
    case CycleOutcome::RECEIVE_FAILED: ++counters_.receive_failed; break;
    case CycleOutcome::SHORT_ANSWER: ++counters_.short_answer; break;
    case CycleOutcome::WRITE_LOST: ++counters_.write_lost; break;
    case CycleOutcome::OTHER_BOARD: break;
    }
    counters_.stale += log_.last().stale;
    failed_ = outcome != CycleOutcome::DONE;
    rewriting_ = rewriting_ || failed_;
    errors_.count(failed_, settings);
}

bool EthernetBus::write(std::span<const RegisterWrite> writes) noexcept {
    if (link_ != Link::RUNNING) {
        return false;
    }
    bool sent = true;
    PacketWriter packet;
    std::size_t slot = 0;
    const auto send = [&] {
        ++host_packets_;
        sent = numbers_.append_to_write(packet, slot) && transport_->send(packet.bytes()).isDone() && sent;
        packet.clear();
        ++slot;
    };
    while (!writes.empty()) {
        const std::size_t size = block_of(writes);
        if (packet.bytes().size() + block_bytes(size) + HostNumbers::WRITE_BYTES > lbp16::MAX_PACKET_BYTES) {
            send();
            if (slot == HostNumbers::MAX_WRITE_PACKETS) {
                return false;  // set_lists() rejects such a list
            }
        }
        append_block(packet, writes.first(size));
        writes = writes.subspan(size);
    }
    send();
    if (!log_.isEmpty()) {
        log_.last().written_ns = transport_->now_ns();
    }
    return sent;
}

bool EthernetBus::redirect(int range, std::uint16_t address) noexcept {
    const auto i = static_cast<std::size_t>(range);
    const bool possible = i < single_offsets_.size() && single_offsets_[i] != 0;
    if (possible) {
        cyclic_.packet.replace(single_offsets_[i], lbp16::bytes_of_number(address));
    }
    return possible;
}

bool EthernetBus::take_rewrite() noexcept {
    const bool rewriting = rewriting_;
    rewriting_ = false;
    return rewriting;
}

bool EthernetBus::take_restart() noexcept {
    const bool restarted = restarted_;
    restarted_ = false;
    return restarted;
}

void EthernetBus::stop() noexcept {
    link_ = Link::STOPPED;
    requested_ = false;
}

void EthernetBus::resume() noexcept {
    if (link_ == Link::STOPPED) {
        errors_.reset();
        link_ = Link::COMPARING;
    }
}

}  // namespace mw::mesa
