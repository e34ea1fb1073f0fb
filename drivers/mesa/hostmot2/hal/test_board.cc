// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/hostmot2/hal/test_board.hh"

#include <algorithm>
#include <cerrno>
#include <map>

#include "drivers/mesa/identity/idrom.hh"
#include "rtapi.h"

namespace mw::mesa {

namespace {

constexpr std::uint16_t IDROM = 0x0400, MODULES = 0x0040, PINS = 0x0200;
constexpr std::uint32_t LOW_HZ = 2'000'000, HIGH_HZ = 20'000'000;
constexpr int WIDTH = 24, ODD_WIDTH = 5, MANY_PORTS = 6;

/// An error in a description. The words are those of the header, in its order.
struct Pattern {
    std::uint32_t cookie = COOKIE;
    bool has_name = true;
    std::uint32_t type = 2, ports = 1, width_of_all = WIDTH, port_width = WIDTH;
    std::uint32_t clock_low = LOW_HZ, clock_high = HIGH_HZ;
    bool has_pins = true;
    int card_ports = 1, card_width = WIDTH;
};

constexpr Pattern PATTERNS[] = {
    {.cookie = 0},
    {.has_name = false},
    {.type = 0},
    {.type = 0x1234},
    {.port_width = 0},
    {.port_width = 29},
    {.ports = 0},
    {.width_of_all = 99},
    {.ports = 2, .width_of_all = 2 * WIDTH},
    {.clock_low = 12345},
    {.clock_high = 0},
    {.ports = MANY_PORTS, .width_of_all = MANY_PORTS * WIDTH, .has_pins = false, .card_ports = MANY_PORTS},
    {},
    {.card_width = ODD_WIDTH},
    {.ports = 0, .width_of_all = 0},
};

/// A board that works only while it is loaded.
class TestBus final : public RegisterBus {
  public:
    explicit TestBus(const Pattern &pattern) : pattern_(pattern) {
        set(COOKIE_ADDRESS, {pattern.cookie});
        constexpr std::uint32_t HOST = 0x54534F48, MOT2 = 0x32544F4D;  // "HOST", "MOT2"
        if (pattern.has_name) {
            set(CONFIG_NAME_ADDRESS, {HOST, MOT2});
        }
        set(IDROM_OFFSET_ADDRESS, {IDROM});
        set(IDROM, {pattern.type, MODULES, PINS, 0, 0, 0, 0, pattern.ports, pattern.width_of_all,
                    pattern.port_width, pattern.clock_low, pattern.clock_high});
        constexpr std::uint32_t PLAIN_PIN = static_cast<std::uint32_t>(Gtag::IO_PORT) << 24U;
        for (std::uint32_t i = 0; pattern.has_pins && i < pattern.width_of_all; ++i) {
            set(static_cast<std::uint16_t>(IDROM + PINS + 4 * i), {PLAIN_PIN});
        }
    }

    std::string card_name() const override { return "test"; }
    std::vector<std::string> connectors() const override {
        return std::vector<std::string>(static_cast<std::size_t>(pattern_.card_ports), "P");
    }
    int port_width() const override { return pattern_.card_width; }
    Result<std::vector<std::uint32_t>> read_now(RegisterRange range) override {
        std::vector<std::uint32_t> values;
        for (int i = 0; i < range.count; ++i) {
            const auto found = registers_.find(static_cast<std::uint16_t>(range.address + 4 * i));
            values.push_back(found == registers_.end() ? 0 : found->second);
        }
        return values;
    }
    Result<> write_now(std::uint16_t, std::span<const std::uint32_t>) override { return {}; }
    Result<> set_lists(std::span<const RegisterRange>, int) override { return {}; }
    void request() noexcept override {}
    CycleRead read(std::span<std::uint32_t> values, long) noexcept override {
        std::ranges::fill(values, 0U);
        return CycleRead::DONE;
    }
    bool write(std::span<const RegisterWrite>) noexcept override { return true; }
    bool take_rewrite() noexcept override { return false; }

  private:
    void set(std::uint16_t address, std::initializer_list<std::uint32_t> values) {
        for (const std::uint32_t value : values) {
            registers_[address] = value;
            address = static_cast<std::uint16_t>(address + 4);
        }
    }
    Pattern pattern_;
    std::map<std::uint16_t, std::uint32_t> registers_;
};

}  // namespace

int load_test_board(int comp_id, int pattern) {
    // LinuxCNC's test searches for this line among the errors.
    rtapi_print_msg(RTAPI_MSG_ERR, "hm2_test: loading HostMot2 test driver with test pattern %d\n", pattern);
    if (pattern < 0 || pattern >= static_cast<int>(std::size(PATTERNS))) {
        rtapi_print_msg(RTAPI_MSG_ERR, "hm2_test: unknown test pattern %d\n", pattern);
        return -ENODEV;
    }
    TestBus bus(PATTERNS[pattern]);
    const int status = register_board({comp_id, "hm2_test.0", &bus, ""});
    if (status < 0) {
        rtapi_print_msg(RTAPI_MSG_ERR, "hm2_test.0: hm2_test fails HM2 registration\n");
        return status;
    }
    unregister_boards(comp_id);  // every pattern contains an error
    return -EIO;
}

}  // namespace mw::mesa
