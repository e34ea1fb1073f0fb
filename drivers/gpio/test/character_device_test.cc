// SPDX-License-Identifier: GPL-2.0-or-later
// Tests the calls of the character device with a simulated kernel that has two chips.
#include <linux/gpio.h>

#include <cerrno>
#include <cstring>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/gpio/character_device.hh"

namespace mw::gpio {
namespace {

/// Responds as Linux does for chips with named lines.
struct Kernel final : System {
    struct Request {
        int chip;
        gpio_v2_line_request wanted;
    };
    std::vector<std::vector<std::string>> chips{{"GPIO0", "GPIO5", "GPIO6"}, {"", "LED", "GPIO20", "GPIO21"}};
    std::map<int, Request> requests;
    std::map<std::string, bool> levels;  ///< electrical levels by name of the line
    int next_file = 100;
    int calls = 0;
    int failing = 0;  ///< errno returned by reads and writes
    int busy = 0;
    std::vector<int> closed;

    int open(const char *path) noexcept override {
        const int chip = std::atoi(path + std::strlen("/dev/gpiochip"));
        if (chip >= static_cast<int>(chips.size())) {
            errno = ENOENT;
            return -1;
        }
        return 10 + chip;
    }
    int control(int file, unsigned long request, void *argument) noexcept override {
        if (request == GPIO_GET_CHIPINFO_IOCTL) {
            static_cast<gpiochip_info *>(argument)->lines =
                static_cast<std::uint32_t>(chips[file - 10].size());
            return 0;
        }
        if (request == GPIO_V2_GET_LINEINFO_IOCTL) {
            auto &info = *static_cast<gpio_v2_line_info *>(argument);
            std::strncpy(info.name, chips[file - 10][info.offset].c_str(), sizeof info.name - 1);
            return 0;
        }
        if (request == GPIO_V2_GET_LINE_IOCTL) {
            if (busy != 0) {
                errno = busy;
                return -1;
            }
            auto &wanted = *static_cast<gpio_v2_line_request *>(argument);
            wanted.fd = next_file++;
            requests[wanted.fd] = {file - 10, wanted};
            return 0;
        }
        ++calls;
        if (failing != 0) {
            errno = failing;
            return -1;
        }
        const Request &lines = requests.at(file);
        auto &values = *static_cast<gpio_v2_line_values *>(argument);
        for (std::uint32_t i = 0; i < lines.wanted.num_lines; ++i) {
            bool &level = levels[chips[lines.chip][lines.wanted.offsets[i]]];
            const bool low = (flags(lines.wanted, i) & GPIO_V2_LINE_FLAG_ACTIVE_LOW) != 0;
            if ((values.mask & bit_of(i)) == 0) {
                continue;
            }
            if (request == GPIO_V2_LINE_SET_VALUES_IOCTL) {
                level = ((values.bits & bit_of(i)) != 0) != low;
            } else {
                values.bits = level != low ? values.bits | bit_of(i) : values.bits & ~bit_of(i);
            }
        }
        return 0;
    }
    void close(int file) noexcept override { closed.push_back(file); }

    static std::uint64_t flags(const gpio_v2_line_request &wanted, std::uint32_t line) {
        for (std::uint32_t i = 0; i < wanted.config.num_attrs; ++i) {
            if ((wanted.config.attrs[i].mask & bit_of(line)) != 0) {
                return wanted.config.attrs[i].attr.flags;
            }
        }
        return wanted.config.flags;
    }
};

Lines lines_of(std::initializer_list<Line> list) {
    Lines lines;
    for (const Line &line : list) {
        lines.line[lines.count++] = line;
    }
    return lines;
}

TEST(GpioCharacterDevice, FindsLinesByNameOnAnyChip) {
    Kernel kernel;
    CharacterDevice device(kernel);
    const Lines lines =
        lines_of({{.name = "GPIO6"}, {.name = "GPIO20", .direction = Direction::OUTPUT}, {.name = "GPIO5"}});
    ASSERT_EQ(device.open("test", lines), 0);
    kernel.levels["GPIO5"] = true;
    Levels levels = 0;
    EXPECT_TRUE(device.read(levels));
    EXPECT_EQ(levels, bit_of(2));
    EXPECT_TRUE(device.write(bit_of(1)));
    EXPECT_TRUE(kernel.levels["GPIO20"]);
    EXPECT_EQ(kernel.calls, 2) << "one call reads the lines of a chip, one writes them";
    device.close();
    EXPECT_EQ(kernel.closed.size(), 4U);
}

TEST(GpioCharacterDevice, EachLineHasItsSettings) {
    Kernel kernel;
    CharacterDevice device(kernel);
    const Lines lines =
        lines_of({{.name = "GPIO5", .bias = Bias::PULL_UP, .inverted = true},
                  {.name = "GPIO6"},
                  {.name = "GPIO20", .direction = Direction::OUTPUT, .drive = Drive::OPEN_DRAIN},
                  {.name = "GPIO21", .direction = Direction::OUTPUT, .inverted = true}});
    ASSERT_EQ(device.open("test", lines), 0);
    const auto &inputs = kernel.requests.at(100).wanted;
    EXPECT_EQ(Kernel::flags(inputs, 0),
              GPIO_V2_LINE_FLAG_INPUT | GPIO_V2_LINE_FLAG_ACTIVE_LOW | GPIO_V2_LINE_FLAG_BIAS_PULL_UP);
    EXPECT_EQ(Kernel::flags(inputs, 1), static_cast<std::uint64_t>(GPIO_V2_LINE_FLAG_INPUT));
    const auto &outputs = kernel.requests.at(101).wanted;
    EXPECT_EQ(Kernel::flags(outputs, 0), GPIO_V2_LINE_FLAG_OUTPUT | GPIO_V2_LINE_FLAG_OPEN_DRAIN);
    kernel.levels["GPIO5"] = false;
    Levels levels = 0;
    EXPECT_TRUE(device.read(levels));
    EXPECT_EQ(levels, bit_of(0)) << "an inverted line is active while it is low";
    EXPECT_TRUE(device.write(0));
    EXPECT_TRUE(kernel.levels["GPIO21"]);
}

TEST(GpioCharacterDevice, ANameThatNoChipHasIsAnError) {
    Kernel kernel;
    CharacterDevice device(kernel);
    EXPECT_EQ(device.open("test", lines_of({{.name = "GPIO99"}})), -ENOENT);
    EXPECT_TRUE(kernel.requests.empty());
}

TEST(GpioCharacterDevice, ALineOfAnotherProgramIsAnError) {
    Kernel kernel;
    kernel.busy = EBUSY;
    CharacterDevice device(kernel);
    EXPECT_EQ(device.open("test", lines_of({{.name = "GPIO5"}})), -EBUSY);
}

TEST(GpioCharacterDevice, WithoutAChipThereIsAnError) {
    Kernel kernel;
    kernel.chips.clear();
    CharacterDevice device(kernel);
    EXPECT_EQ(device.open("test", lines_of({{.name = "GPIO5"}})), -ENODEV);
}

TEST(GpioCharacterDevice, AFailureKeepsTheLastStates) {
    Kernel kernel;
    CharacterDevice device(kernel);
    ASSERT_EQ(device.open("test",
                          lines_of({{.name = "GPIO5"}, {.name = "GPIO20", .direction = Direction::OUTPUT}})),
              0);
    kernel.failing = EIO;
    Levels levels = bit_of(0);
    EXPECT_FALSE(device.read(levels));
    EXPECT_EQ(levels, bit_of(0));
    EXPECT_FALSE(device.write(bit_of(1)));
}

// Reads and writes have separate states: successful reads do not end a failure of writes.
TEST(GpioFailureState, BeginsOnce) {
    FailureState writing;
    EXPECT_FALSE(writing.begins(true));
    EXPECT_TRUE(writing.begins(false));
    EXPECT_FALSE(writing.begins(false));
    EXPECT_TRUE(writing.isFailing());
    EXPECT_FALSE(writing.begins(true));
    EXPECT_FALSE(writing.isFailing());
    EXPECT_TRUE(writing.begins(false));
}

TEST(GpioCharacterDevice, ReadsAndWrites64Lines) {
    Kernel kernel;
    kernel.chips = {{}};
    Lines lines;
    for (std::size_t i = 0; i < MAX_LINES; ++i) {
        kernel.chips[0].push_back("L" + std::to_string(i));
        lines.line[i] = {.direction = Direction::OUTPUT};
        std::strncpy(lines.line[i].name, kernel.chips[0].back().c_str(), NAME_SIZE - 1);
    }
    lines.count = MAX_LINES;
    CharacterDevice device(kernel);
    ASSERT_EQ(device.open("test", lines), 0);
    EXPECT_TRUE(device.write(0xF0F0F0F0F0F0F0F0));
    for (std::size_t i = 0; i < MAX_LINES; ++i) {
        EXPECT_EQ(kernel.levels["L" + std::to_string(i)], (i / 4) % 2 == 1) << i;
    }
}

}  // namespace
}  // namespace mw::gpio
