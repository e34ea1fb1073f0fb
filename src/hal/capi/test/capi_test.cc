// SPDX-License-Identifier: GPL-2.0-or-later
// The C API as components and programs call it.
#include <sys/stat.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "hal/core/test/machine.hh"
#include "hal/include/hal.h"
#include "hal/include/kinematics.h"
#include "hal/include/millwright_ext.h"
#include "hal/include/rtapi_firmware.h"
#include "hal/include/rtapi_mutex.h"
#include "hal/include/rtapi_parport.h"
#include "hal/include/rtapi_pci.h"

namespace mw::hal {
namespace {

/// An instance and a component with one object of each type.
struct CInterface : ::testing::Test {
    TestMachine machine;
    UseInstance use{machine.host.get() == nullptr ? nullptr : &machine.hal()};
    int comp = hal_init("c");
    struct Pins {
        hal_float_t *in;
        hal_bit_t *out;
        hal_sint_t wide;
        hal_s32_t level;
    } *pins = static_cast<Pins *>(hal_malloc(sizeof(Pins)));

    CInterface() {
        hal_pin_float_newf(HAL_IN, &pins->in, comp, "%s.in", "c");
        hal_pin_bit_newf(HAL_OUT, &pins->out, comp, "c.out");
        hal_pin_new_sint(comp, HAL_IO, &pins->wide, -7, "c.wide");
        hal_param_s32_newf(HAL_RW, &pins->level, comp, "c.level");
        hal_signal_new("s", HAL_FLOAT);
        hal_link("c.in", "s");
        hal_ready(comp);
    }
};

int add_name(hal_query_t *query, void *names) {
    *static_cast<std::string *>(names) += std::string(query->name) + " ";
    return 0;
}

TEST_F(CInterface, GivesZeroedMemoryInHugePages) {
    constexpr std::size_t HUGE_PAGE = std::size_t{2} << 20U;
    constexpr std::size_t BYTES = HUGE_PAGE + 100;
    auto *memory = static_cast<unsigned char *>(mw_ext_memory_new(BYTES));
    ASSERT_NE(memory, nullptr);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(memory) % HUGE_PAGE, 0U);
    EXPECT_EQ(memory[0] + memory[BYTES - 1], 0);
    memory[BYTES - 1] = 1;
    mw_ext_memory_delete(memory, BYTES);
    mw_ext_memory_delete(nullptr, BYTES);
}

TEST_F(CInterface, ListsWhatThereIs) {
    std::string names;
    EXPECT_EQ(hal_list_p(nullptr, add_name, &names), 0);
    EXPECT_EQ(names, "c.in c.out c.wide c.level ");
    names.clear();
    hal_query_t query{};
    query.qtype = HAL_QTYPE_PIN;
    query.name = "c.?ut";
    EXPECT_EQ(hal_list_p(&query, add_name, &names), 0);
    EXPECT_EQ(names, "c.out ");
    names.clear();
    query = {};
    query.name = "s";
    EXPECT_EQ(hal_list_p_s(&query, add_name, &names), 0);
    EXPECT_EQ(names, "c.in ");
    query.name = "none";
    EXPECT_EQ(hal_list_p_s(&query, add_name, &names), -ENOENT);
    names.clear();
    EXPECT_EQ(hal_list_s(nullptr, add_name, &names), 0);
    EXPECT_EQ(hal_list_comp(nullptr, add_name, &names), 0);
    EXPECT_EQ(names, "s c ");
    EXPECT_EQ(hal_list_p(nullptr, [](hal_query_t *, void *) { return 5; }, nullptr), 5) << "ends the list";
    EXPECT_EQ(hal_list_p(nullptr, nullptr, nullptr), -EINVAL);
}

TEST_F(CInterface, GetsAndSetsByName) {
    hal_query_t query{};
    query.name = "c.wide";
    ASSERT_EQ(hal_get_p(&query, nullptr, nullptr), 0);
    EXPECT_EQ(query.pp.type, HAL_SINT);
    EXPECT_EQ(query.pp.dir, HAL_IO);
    EXPECT_EQ(query.pp.value.s, -7);
    EXPECT_STREQ(query.pp.comp, "c");
    query.pp.value.s = 1234567890123;
    ASSERT_EQ(hal_set_p(&query, nullptr, nullptr), 0);
    EXPECT_EQ(hal_get_sint(pins->wide), 1234567890123);
    query = {};
    query.name = "c.level";
    EXPECT_EQ(hal_set_p(
                  &query,
                  [](hal_query_t *found, void *) {
                      found->pp.value.s32 = 41 + found->pp.value.s32;
                      return 0;
                  },
                  nullptr),
              0);
    EXPECT_EQ(pins->level, 41);
    query = {};
    query.name = "c.out";
    EXPECT_LT(hal_set_p(&query, nullptr, nullptr), 0) << "an output";
    query.name = "s";
    query.sig.value.r = 2.5;
    EXPECT_EQ(hal_set_s(&query, nullptr, nullptr), 0);
    EXPECT_EQ(*pins->in, 2.5);
    query = {};
    query.name = "nothing";
    EXPECT_EQ(hal_get_p(&query, nullptr, nullptr), -ENOENT);
    EXPECT_STREQ(query.name, "nothing");
    EXPECT_EQ(hal_get_s(&query, nullptr, nullptr), -ENOENT);
}

TEST_F(CInterface, GivesReferencesThatCanBeMapped) {
    hal_query_t query{};
    query.name = "c.in";
    ASSERT_EQ(hal_getref_p(&query), 0);
    EXPECT_STREQ(query.pp.signal, "s");
    auto *value = static_cast<hal_float_t *>(hal_reference_map(query.pp.ref));
    ASSERT_NE(value, nullptr);
    *value = 3.5;
    EXPECT_EQ(*pins->in, 3.5);
    EXPECT_EQ(hal_reference_unmap(const_cast<double *>(value)), 0);
    EXPECT_EQ(hal_reference_map(-1), nullptr);
    EXPECT_EQ(hal_reference_map(1L << 40), nullptr);
    EXPECT_EQ(hal_reference_unmap(&query), -EINVAL);
}

TEST_F(CInterface, DescribesComponentsAndCounts) {
    hal_query_t query{};
    ASSERT_EQ(hal_comp_by_name("c", &query), 0);
    EXPECT_EQ(query.comp.comp_id, comp);
    EXPECT_EQ(query.comp.ready, 1);
    EXPECT_EQ(query.comp.insmod, nullptr);
    EXPECT_EQ(hal_comp_by_id(comp, &query), 0);
    EXPECT_EQ(hal_comp_by_id(99, &query), -ENOENT);
    hal_statistics_t figures{};
    ASSERT_EQ(hal_statistics(&figures), 0);
    EXPECT_EQ(figures.components, 1);
    EXPECT_EQ(figures.pins, 3);
    EXPECT_EQ(figures.signals, 1);
    EXPECT_GT(figures.memory_size, figures.memory_used);
    EXPECT_EQ(hal_mutex_force_release(), 0);
    EXPECT_EQ(hal_get_realtime_type(), REALTIME_TYPE_NONE);
}

std::string made;

TEST_F(CInterface, MakesInstancesByConstructor) {
    EXPECT_EQ(hal_comp_invoke_make("c", "n", ""), -ENOSYS);
    ASSERT_EQ(hal_set_constructor(comp,
                                  [](const char *prefix, const char *arg) {
                                      made = std::string(prefix) + "," + arg;
                                      return 7;
                                  }),
              0);
    EXPECT_EQ(hal_comp_invoke_make("c", "new", "x=1"), 7);
    EXPECT_EQ(made, "new,x=1");
    EXPECT_LT(hal_comp_invoke_make("d", "new", ""), 0);
    EXPECT_EQ(hal_set_constructor(99, nullptr), -EINVAL);
    hal_exit(comp);
    EXPECT_LT(hal_comp_invoke_make("c", "new", ""), 0);
}

TEST_F(CInterface, PassesBytesThroughQueues) {
    const int writer = rtapi_fifo_new(5, 1, 6, 'W');
    const int reader = rtapi_fifo_new(5, 1, 6, 'R');
    ASSERT_GT(writer, 0);
    EXPECT_EQ(reader, writer);
    char text[] = "abcdefghij";
    char got[16] = {};
    for (int round = 0; round < 5; ++round) {
        EXPECT_EQ(rtapi_fifo_write(writer, text, 10), 8) << "the size is rounded up to a power of two";
        EXPECT_EQ(rtapi_fifo_read(reader, got, 3), 3);
        EXPECT_EQ(rtapi_fifo_read(reader, got + 3, 10), 5);
        EXPECT_STREQ(got, "abcdefgh");
    }
    EXPECT_EQ(rtapi_fifo_read(reader, got, 3), 0);
    EXPECT_LT(rtapi_fifo_new(5, 1, 6, 'X'), 0);
    EXPECT_EQ(rtapi_fifo_read(-1, got, 1), -EINVAL);
    EXPECT_EQ(rtapi_fifo_delete(writer, 1), 0);
    EXPECT_EQ(rtapi_fifo_delete(reader, 1), 0);
    EXPECT_EQ(rtapi_fifo_delete(reader, 1), -EINVAL);
}

TEST_F(CInterface, SharesSemaphoresByKey) {
    const int first = rtapi_sem_new(3, 1);
    ASSERT_GT(first, 0);
    EXPECT_EQ(rtapi_sem_new(3, 2), first);
    EXPECT_NE(rtapi_sem_new(4, 1), first);
    EXPECT_EQ(rtapi_sem_take(first), 0);
    EXPECT_EQ(rtapi_sem_try(first), -EBUSY);
    EXPECT_EQ(rtapi_sem_give(first), 0);
    EXPECT_EQ(rtapi_sem_give(first), 0) << "with two gives it is free once";
    EXPECT_EQ(rtapi_sem_try(first), 0);
    EXPECT_EQ(rtapi_sem_try(first), -EBUSY);
    EXPECT_EQ(rtapi_sem_delete(first, 1), 0);
    EXPECT_EQ(rtapi_sem_delete(first, 2), 0);
    EXPECT_EQ(rtapi_sem_try(first), -EINVAL) << "gone";
}

TEST_F(CInterface, SaysWhyHardwareIsOutOfReach) {
    EXPECT_LT(rtapi_task_new([](void *) {}, nullptr, rtapi_prio_lowest(), 1, 0, 0), 0) << "virtual clock";
    EXPECT_EQ(rtapi_task_self(), -EINVAL);
    EXPECT_EQ(rtapi_task_pll_set_correction(5), -EINVAL);
    EXPECT_EQ(rtapi_irq_new(7, 1, nullptr), -ENOSYS);
    EXPECT_EQ(rtapi_inb(0x378), 0xff) << "a port that is not claimed";
    rtapi_parport_t port{};
    EXPECT_EQ(rtapi_parport_get("c", &port, 9, 0, 0), -ENODEV);
    EXPECT_NE(machine.messages.all().find("Linux knows no parallel port 9"), std::string::npos);
    EXPECT_EQ(rtapi_open_as_root("/nonexistent", 0), -ENOENT);
    EXPECT_GT(rtapi_prio_next_higher(rtapi_prio_lowest()), 0);
}

// A second process, such as doctor, must not access hardware that moves a machine.
TEST_F(CInterface, TouchesNoPortUnderTheVirtualClock) {
    constexpr unsigned short DATA = 0x378;
    void *const region = rtapi_request_region(DATA, 3, "c");
    ASSERT_NE(region, nullptr) << "also without CAP_SYS_RAWIO";
    rtapi_outb(0x55, DATA);
    EXPECT_EQ(rtapi_inb(DATA), 0xff);
    EXPECT_EQ(rtapi_request_region(DATA + 1, 1, "other"), nullptr) << "regions have an owner anyway";
    rtapi_release_region(DATA, 3);
    ::unsetenv("MILLWRIGHT_SYSFS");
    static const rtapi_pci_device_id table[] = {{0x2718, 0x5125, 0, 0, 0, 0, 42}, {}};
    rtapi_pci_driver driver{};
    driver.name = "cards";
    driver.id_table = table;
    driver.probe = [](rtapi_pci_dev *, const rtapi_pci_device_id *) { return 0; };
    EXPECT_EQ(rtapi_pci_register_driver(&driver), 0);
    EXPECT_EQ(driver.devices, nullptr);
    EXPECT_NE(machine.messages.all().find("cards: PCI cards are not used under the virtual clock"),
              std::string::npos);
}

namespace fs = std::filesystem;

void write_file(const fs::path &path, const std::string &text) {
    fs::create_directories(path.parent_path());
    std::ofstream(path) << text;
}

int probed;
void *mapped;

TEST_F(CInterface, FindsCardsAndMapsTheirRegisters) {
    const fs::path root = fs::path(::testing::TempDir()) / "mw_sysfs";
    fs::remove_all(root);
    const fs::path card = root / "bus/pci/devices/0000:03:00.0";
    write_file(card / "vendor", "0x2718\n");
    write_file(card / "device", "0x5125\n");
    write_file(card / "enable", "0");
    write_file(card / "resource", "0x0 0x0 0x0\n0x1000 0x1fff 0x200\n");
    write_file(card / "resource1", std::string(4096, 'x'));
    ::setenv("MILLWRIGHT_SYSFS", root.c_str(), 1);
    static const rtapi_pci_device_id table[] = {{0x2718, 0x5125, 0, 0, 0, 0, 42}, {}};
    rtapi_pci_driver driver{};
    driver.name = "test";
    driver.id_table = table;
    driver.probe = [](rtapi_pci_dev *dev, const rtapi_pci_device_id *id) {
        probed = static_cast<int>(id->driver_data);
        EXPECT_EQ(rtapi_pci_enable_device(dev), 0);
        EXPECT_EQ(rtapi_pci_resource_len(dev, 0), 0U);
        EXPECT_EQ(rtapi_pci_resource_len(dev, 1), 4096U);
        mapped = const_cast<void *>(rtapi_pci_ioremap_bar(dev, 1));
        EXPECT_EQ(rtapi_pci_ioremap_bar(dev, 0), nullptr);
        rtapi_pci_set_drvdata(dev, &probed);
        return 0;
    };
    driver.remove = [](rtapi_pci_dev *dev) {
        EXPECT_EQ(rtapi_pci_get_drvdata(dev), &probed);
        rtapi_iounmap(mapped);
        probed = 0;
    };
    ASSERT_EQ(rtapi_pci_register_driver(&driver), 0);
    EXPECT_EQ(probed, 42);
    ASSERT_NE(mapped, nullptr);
    EXPECT_EQ(static_cast<char *>(mapped)[4095], 'x');
    rtapi_pci_unregister_driver(&driver);
    EXPECT_EQ(probed, 0);
    ::unsetenv("MILLWRIGHT_SYSFS");
    fs::remove_all(root);
}

TEST_F(CInterface, ReadsFirmware) {
    const fs::path root = fs::path(::testing::TempDir()) / "mw_firmware";
    write_file(root / "card/a.bit", "bits");
    ::setenv("MILLWRIGHT_FIRMWARE", root.c_str(), 1);
    rtapi_device device{};
    EXPECT_EQ(rtapi_dev_set_name(&device, "card%d", 1), 0);
    const rtapi_firmware *firmware = nullptr;
    ASSERT_EQ(rtapi_request_firmware(&firmware, "card/a.bit", &device), 0);
    EXPECT_EQ(firmware->size, 4U);
    EXPECT_EQ(std::memcmp(firmware->data, "bits", 4), 0);
    rtapi_release_firmware(firmware);
    EXPECT_EQ(rtapi_request_firmware(&firmware, "none", &device), -ENOENT);
    ::unsetenv("MILLWRIGHT_FIRMWARE");
    fs::remove_all(root);
}

TEST_F(CInterface, MapsCoordinatesToJoints) {
    int axes[5] = {};
    ASSERT_EQ(map_coordinates_to_jnumbers("XYZY", 5, 1, axes), 0);
    EXPECT_EQ(axes[3], 1);
    EXPECT_EQ(axes[4], -1);
    EXPECT_EQ(map_coordinates_to_jnumbers("XYZY", 5, 0, axes), -1);
    EXPECT_EQ(map_coordinates_to_jnumbers("XQ", 5, 1, axes), -1);
    const double joints[5] = {1, 2, 3, 4, 5};
    EmcPose pose{};
    EXPECT_EQ(mapped_joints_to_position(5, joints, &pose), 0);
    EXPECT_EQ(pose.tran.y, 2) << "the first of two joints";
    double back[5] = {};
    EXPECT_EQ(position_to_mapped_joints(5, &pose, back), 0);
    EXPECT_EQ(back[3], 2);
}

TEST(RtapiMutex, LetsManyReadOrOneWrite) {
    unsigned long word = 0;
    EXPECT_EQ(rtapi_mutex_try_rd(&word), 0);
    EXPECT_EQ(rtapi_mutex_try_rd(&word), 0);
    EXPECT_EQ(rtapi_mutex_try(&word), 1);
    rtapi_mutex_give_rd(&word);
    rtapi_mutex_give_rd(&word);
    EXPECT_EQ(rtapi_mutex_try(&word), 0);
    EXPECT_EQ(rtapi_mutex_try_rd(&word), 1);
    rtapi_mutex_give(&word);
}

}  // namespace
}  // namespace mw::hal
