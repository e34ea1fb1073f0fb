// SPDX-License-Identifier: GPL-2.0-or-later
// Loading of the Ethernet bus; these functions may allocate memory and wait.
#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>

#include <fmt/format.h>

#include "drivers/mesa/ethernet/ethernet_bus.hh"
#include "drivers/mesa/identity/idrom.hh"

namespace mw::mesa {

namespace {

using lbp16::PacketWriter;
using lbp16::Space;
using lbp16::Unit;

constexpr std::int64_t TIMEOUT_NS = 200'000'000;
constexpr int TRIES = 3;
/// Maximum number of answers to earlier requests that are discarded before a new request.
constexpr int MOST_OLD = 64;
constexpr int NAME_WORDS = 8, MAC_WORDS = 3;
constexpr std::uint16_t MAC_ADDRESS = 2;
constexpr std::uint16_t RECEIVED_PACKETS_ADDRESS = 8;
/// Header, modules and pins of the largest IDROM [registers].
constexpr int IDROM_REGISTERS = 272;
/// Cookie, name of the firmware, offset of the IDROM [registers].
constexpr int FIRMWARE_REGISTERS = 4;

bool append_reads(PacketWriter &packet, RegisterRange range) {
    while (range.count > 0) {
        const int count = std::min<int>(range.count, lbp16::MAX_UNITS);
        if (!packet.read_registers(range.address, count)) {
            return false;
        }
        range.address = static_cast<std::uint16_t>(range.address + 4 * count);
        range.count = static_cast<std::uint16_t>(range.count - count);
    }
    return true;
}

bool append_words(PacketWriter &packet, Space space, std::uint16_t address, int words) {
    return packet.read({.space = space,
                        .unit = Unit::BITS_16,
                        .units = static_cast<std::uint8_t>(words),
                        .address = address});
}

std::string text_of(std::span<const std::byte> bytes) {
    std::string text;
    for (const std::byte byte : bytes) {
        text += static_cast<char>(byte);
    }
    text.resize(std::min(text.find('\0'), text.size()));
    text.resize(text.find_last_not_of(' ') + 1);
    return text;
}

}  // namespace

EthernetBus::EthernetBus(std::unique_ptr<lbp16::Transport> transport, std::string address)
    : transport_(std::move(transport)), address_(std::move(address)) {}

Result<std::unique_ptr<EthernetBus>> EthernetBus::open(std::unique_ptr<lbp16::Transport> transport,
                                                       std::string address) {
    std::unique_ptr<EthernetBus> bus(new EthernetBus(std::move(transport), std::move(address)));
    if (auto identified = bus->identify(); !identified) {
        return std::unexpected(identified.error());
    }
    return bus;
}

Result<> EthernetBus::identify() {
    PacketWriter name;
    append_words(name, Space::BOARD, 0, NAME_WORDS);
    const auto answer = exchange(name, "the request for its name");
    if (!answer) {
        return std::unexpected(answer.error());
    }
    reported_name_ = text_of(*answer);
    card_ = find_ethernet_card(reported_name_);
    PacketWriter firmware;
    append_reads(firmware, {.address = COOKIE_ADDRESS, .count = FIRMWARE_REGISTERS});
    const auto words = exchange(firmware, "the request for its firmware");
    if (!words) {
        return std::unexpected(words.error());
    }
    if (lbp16::number_at<std::uint32_t>(*words) != COOKIE) {
        return fail(
            fmt::format("the board {} at {} has no HostMot2 firmware: its cookie is {:#010x}, not {:#010x}",
                        reported_name_, address_, lbp16::number_at<std::uint32_t>(*words), COOKIE),
            {}, "write a HostMot2 firmware to the board with mesaflash");
    }
    const auto idrom = lbp16::number_at<std::uint32_t>(std::span(*words).subspan(12));
    constexpr std::uint32_t LAST_IDROM = 0x10000 - 4 * IDROM_REGISTERS;
    if (idrom % 4 != 0 || idrom > LAST_IDROM) {
        return fail(fmt::format(
            "the firmware of the board {} at {} has its description at {:#x}, outside the registers",
            reported_name_, address_, idrom));
    }
    // 1,110 bytes: fits into one packet.
    append_reads(identity_.packet, {.address = COOKIE_ADDRESS, .count = FIRMWARE_REGISTERS});
    append_reads(identity_.packet, {.address = static_cast<std::uint16_t>(idrom), .count = IDROM_REGISTERS});
    append_words(identity_.packet, Space::EEPROM, MAC_ADDRESS, MAC_WORDS);
    auto identity = exchange(identity_.packet, "the request for its identity");
    if (!identity) {
        return std::unexpected(identity.error());
    }
    known_identity_ = std::move(*identity);
    identity_.data_bytes = known_identity_.size();
    HostNumbers::append_to_request(identity_.packet);
    return {};
}

std::string EthernetBus::card_name() const {
    if (card_ != nullptr) {
        return std::string(card_->hal_name);
    }
    // An unknown card gets the name that it reports, up to the first hyphen.
    std::string name = reported_name_.substr(0, reported_name_.find('-'));
    std::ranges::transform(name, name.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return name;
}

std::array<std::uint8_t, 6> EthernetBus::mac() const {
    std::array<std::uint8_t, 6> mac{};
    const auto words = std::span(known_identity_).last(mac.size());
    for (std::size_t i = 0; i < mac.size(); ++i) {
        // The lowest word is read first, and in each word the lowest byte.
        mac[i] = std::to_integer<std::uint8_t>(words[mac.size() - 1 - i]);
    }
    return mac;
}

int EthernetBus::port_width() const {
    return card_ != nullptr ? card_->port_width : 0;
}

std::vector<std::string> EthernetBus::connectors() const {
    std::vector<std::string> names;
    for (std::size_t port = 0; card_ != nullptr && port < card_->ports; ++port) {
        names.emplace_back(card_->connectors.at(port));
    }
    return names;
}

Result<std::vector<std::byte>> EthernetBus::exchange(const PacketWriter &packet, std::string_view what) {
    int error = 0;
    for (int attempt = 0; attempt < TRIES; ++attempt) {
        // A late answer would be treated as the answer to this request.
        for (int old = 0; old < MOST_OLD && transport_->receive(answer_).isDone(); ++old) {
        }
        const auto sent = transport_->send(packet.bytes());
        if (!sent.isDone()) {
            error = sent.error;
            continue;
        }
        if (packet.answer_bytes() == 0) {
            return std::vector<std::byte>{};
        }
        const std::int64_t deadline_ns = sent.time_ns + TIMEOUT_NS;
        auto received = transport_->receive(answer_);
        while (!received.isDone() && received.time_ns < deadline_ns) {
            error = received.error != EAGAIN ? received.error : error;
            transport_->wait_until(deadline_ns);
            received = transport_->receive(answer_);
        }
        if (received.isDone() && received.bytes == packet.answer_bytes()) {
            return std::vector<std::byte>(answer_.begin(),
                                          answer_.begin() + static_cast<std::ptrdiff_t>(received.bytes));
        }
    }
    return fail(fmt::format("the board at {} does not answer {}{}", address_, what,
                            error != 0 ? fmt::format(": {}", std::strerror(error)) : std::string()),
                {}, "is it switched on, is the cable connected, and is this its address?");
}

Result<std::vector<std::uint32_t>> EthernetBus::read_now(RegisterRange range) {
    PacketWriter packet;
    if (!append_reads(packet, range)) {
        return fail(fmt::format("{} registers are more than one packet of the board at {} holds", range.count,
                                address_));
    }
    const auto bytes = exchange(packet, fmt::format("the read of register {:#06x}", range.address));
    if (!bytes) {
        return std::unexpected(bytes.error());
    }
    std::vector<std::uint32_t> values;
    for (std::size_t i = 0; i < range.count; ++i) {
        values.push_back(lbp16::number_at<std::uint32_t>(std::span(*bytes).subspan(4 * i)));
    }
    return values;
}

void EthernetBus::pause_now(std::chrono::nanoseconds duration) {
    transport_->wait_until(transport_->now_ns() + duration.count());
}

Result<> EthernetBus::write_now(std::uint16_t address, std::span<const std::uint32_t> values) {
    PacketWriter packet;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (!packet.write_register(static_cast<std::uint16_t>(address + 4 * i), values[i])) {
            return fail(fmt::format("{} registers are more than one packet to the board at {} holds",
                                    values.size(), address_));
        }
    }
    // The board answers only reads; the answer shows that it has executed the writes before.
    if (!append_words(packet, Space::CONTROL, 0, 1)) {
        return fail(fmt::format("{} registers are more than one packet to the board at {} holds",
                                values.size(), address_));
    }
    const auto answer = exchange(packet, fmt::format("the write of register {:#06x}", address));
    if (!answer) {
        return std::unexpected(answer.error());
    }
    return {};
}

Result<> EthernetBus::set_lists(std::span<const RegisterRange> reads, int max_writes) {
    cyclic_ = Request();
    bool fits = true;
    single_offsets_.clear();
    for (const RegisterRange &range : reads) {
        constexpr std::size_t COMMAND_WORD = 2;
        single_offsets_.push_back(range.count == 1 ? cyclic_.packet.bytes().size() + COMMAND_WORD : 0);
        fits = fits && append_reads(cyclic_.packet, range);
    }
    fits = fits && append_words(cyclic_.packet, Space::CONTROL, RECEIVED_PACKETS_ADDRESS, 1);
    cyclic_.data_bytes = cyclic_.packet.answer_bytes();
    fits = fits && HostNumbers::append_to_request(cyclic_.packet);
    if (!fits) {
        return fail(
            fmt::format("the modules of the board at {} need more than {} bytes in one packet of a cycle",
                        address_, lbp16::MAX_PACKET_BYTES),
            {}, "use fewer modules: num_stepgens=, num_encoders= and the like in config=");
    }
    // A write has its maximum length if each register needs its own command.
    constexpr int PER_PACKET = (lbp16::MAX_PACKET_BYTES - HostNumbers::WRITE_BYTES) / 8;
    constexpr int MOST = PER_PACKET * static_cast<int>(HostNumbers::MAX_WRITE_PACKETS);
    if (max_writes > MOST) {
        return fail(
            fmt::format("the modules of the board at {} need {} registers in one write; {} are possible",
                        address_, max_writes, MOST),
            {}, "use fewer modules: num_stepgens=, num_encoders= and the like in config=");
    }
    PacketWriter numbers;
    HostNumbers::append_to_request(numbers);
    const auto answer = exchange(numbers, "the request for its numbers");
    if (!answer) {
        return std::unexpected(answer.error());
    }
    numbers_.accept(*answer);
    return {};
}

}  // namespace mw::mesa
