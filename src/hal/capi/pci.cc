// SPDX-License-Identifier: GPL-2.0-or-later
// rtapi_pci.h, rtapi_device.h, rtapi_firmware.h, implemented with files of Linux.
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdarg>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <vector>

#include <fmt/format.h>

#include "base/atomic_file.hh"
#include "base/text.hh"
#include "hal/capi/status.hh"
#include "hal/include/millwright_ext.h"
#include "hal/include/rtapi_firmware.h"
#include "hal/include/rtapi_pci.h"
#include "runtime/format.hh"

using namespace mw;
using namespace mw::hal::capi;

namespace {

namespace fs = std::filesystem;

/// $MILLWRIGHT_SYSFS replaces /sys in tests.
std::string pci_folder() {
    const char *root = std::getenv("MILLWRIGHT_SYSFS");
    return fmt::format("{}/bus/pci/devices", root == nullptr ? "/sys" : root);
}

std::string file_of(const rtapi_pci_dev &card, std::string_view name) {
    return fmt::format("{}/{}/{}", pci_folder(), card.dev_name, name);
}

std::uint64_t read_number(const std::string &file) {
    const auto text = read_file(file);
    const auto number = text ? parse_uint(trim(*text)) : std::nullopt;
    return number.value_or(0);
}

void read_resources(rtapi_pci_dev &card) {
    const auto text = read_file(file_of(card, "resource"));
    const std::vector<std::string> words = split_words(text ? *text : std::string());
    for (std::size_t bar = 0; bar < RTAPI_PCI_BARS && bar * 3 + 2 < words.size(); ++bar) {
        card.resource[bar].start = parse_uint(words[bar * 3]).value_or(0);
        card.resource[bar].end = parse_uint(words[bar * 3 + 1]).value_or(0);
        card.resource[bar].flags = parse_uint(words[bar * 3 + 2]).value_or(0);
    }
}

rtapi_pci_dev *read_card(const std::string &name) {
    auto *card = static_cast<rtapi_pci_dev *>(std::calloc(1, sizeof(rtapi_pci_dev)));
    if (card == nullptr || name.size() >= sizeof card->dev_name) {
        std::free(card);
        return nullptr;
    }
    std::memcpy(card->dev_name, name.c_str(), name.size() + 1);
    std::memcpy(card->dev.name, name.c_str(), name.size() + 1);
    card->vendor = static_cast<rtapi_u16>(read_number(file_of(*card, "vendor")));
    card->device = static_cast<rtapi_u16>(read_number(file_of(*card, "device")));
    card->subsystem_vendor = static_cast<rtapi_u16>(read_number(file_of(*card, "subsystem_vendor")));
    card->subsystem_device = static_cast<rtapi_u16>(read_number(file_of(*card, "subsystem_device")));
    card->revision = static_cast<rtapi_u8>(read_number(file_of(*card, "revision")));
    card->irq = static_cast<unsigned>(read_number(file_of(*card, "irq")));
    read_resources(*card);
    return card;
}

bool isEqual(rtapi_u32 wanted, rtapi_u32 there) {
    return wanted == RTAPI_PCI_ANY_ID || wanted == there;
}

const rtapi_pci_device_id *find_entry(const rtapi_pci_device_id *table, const rtapi_pci_dev &card) {
    for (; table->vendor != 0 || table->device != 0 || table->subvendor != 0; ++table) {
        // Zeros in the second half of a short entry match all cards.
        const bool any_sub = table->subvendor == 0 && table->subdevice == 0;
        const bool is_sub = any_sub || (isEqual(table->subvendor, card.subsystem_vendor) &&
                                        isEqual(table->subdevice, card.subsystem_device));
        if (isEqual(table->vendor, card.vendor) && isEqual(table->device, card.device) && is_sub) {
            return table;
        }
    }
    return nullptr;
}

std::vector<std::string> card_names() {
    std::vector<std::string> names;
    std::error_code code;
    for (const auto &entry : fs::directory_iterator(pci_folder(), code)) {
        names.push_back(entry.path().filename());
    }
    std::sort(names.begin(), names.end());
    return names;
}

void free_card(rtapi_pci_dev *card) {
    for (rtapi_pci_resource &resource : card->resource) {
        if (resource.mapped != nullptr) {
            ::munmap(resource.mapped, resource.mapped_size);
        }
    }
    std::free(card);
}

/// Cards claimed by drivers, for rtapi_iounmap, which only receives an address.
struct Taken {
    std::mutex mutex;
    std::vector<rtapi_pci_dev *> cards;
};

Taken &taken() {
    static auto *all = new Taken;
    return *all;
}

int write_enable(const rtapi_pci_dev &card, char value) {
    const std::string path = file_of(card, "enable");
    const int file = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
    const bool done = file >= 0 && ::write(file, &value, 1) == 1;
    const int code = done ? 0 : errno;
    if (file >= 0) {
        ::close(file);
    }
    return done ? 0
                : complain(code, fmt::format("PCI card {}: cannot write {}: {}", card.dev_name, path,
                                             std::strerror(code)));
}

}  // namespace

extern "C" {

const char *rtapi_pci_name(const struct rtapi_pci_dev *pdev) {
    return pdev->dev_name;
}

int rtapi_pci_register_driver(struct rtapi_pci_driver *driver) {
    if (driver == nullptr || driver->id_table == nullptr || driver->probe == nullptr) {
        return complain(EINVAL, "a PCI driver needs a table of ids and a probe function");
    }
    driver->devices = nullptr;
    // Another process may control a machine through the PCI cards of this computer.
    if (mw_ext_is_virtual() != 0 && std::getenv("MILLWRIGHT_SYSFS") == nullptr) {
        rtapi_print_msg(RTAPI_MSG_ERR, "%s: PCI cards are not used under the virtual clock\n",
                        driver->name == nullptr ? "PCI driver" : driver->name);
        return 0;
    }
    for (const std::string &name : card_names()) {
        rtapi_pci_dev *card = read_card(name);
        const rtapi_pci_device_id *entry = card == nullptr ? nullptr : find_entry(driver->id_table, *card);
        if (entry == nullptr) {
            std::free(card);
            continue;
        }
        card->driver = driver;
        {
            const std::lock_guard lock(taken().mutex);
            taken().cards.push_back(card);
        }
        if (driver->probe(card, entry) != 0) {
            const std::lock_guard lock(taken().mutex);
            std::erase(taken().cards, card);
            free_card(card);
            continue;
        }
        card->next = driver->devices;
        driver->devices = card;
    }
    return 0;
}

void rtapi_pci_unregister_driver(struct rtapi_pci_driver *driver) {
    while (driver->devices != nullptr) {
        rtapi_pci_dev *card = driver->devices;
        driver->devices = card->next;
        if (driver->remove != nullptr) {
            driver->remove(card);
        }
        const std::lock_guard lock(taken().mutex);
        std::erase(taken().cards, card);
        free_card(card);
    }
}

int rtapi_pci_enable_device(struct rtapi_pci_dev *dev) {
    return write_enable(*dev, '1');
}

int rtapi_pci_disable_device(struct rtapi_pci_dev *dev) {
    return write_enable(*dev, '0');
}

void rtapi__iomem *rtapi_pci_ioremap_bar(struct rtapi_pci_dev *pdev, int bar) {
    if (bar < 0 || bar >= RTAPI_PCI_BARS || rtapi_pci_resource_len(pdev, bar) == 0) {
        complain(EINVAL, fmt::format("PCI card {} has no registers {}", pdev->dev_name, bar));
        return nullptr;
    }
    rtapi_pci_resource &resource = pdev->resource[bar];
    const std::string path = file_of(*pdev, fmt::format("resource{}", bar));
    const int file = rtapi_open_as_root(path.c_str(), O_RDWR | O_SYNC);
    if (file < 0) {
        complain(-file,
                 fmt::format("PCI card {}: cannot open {}: {}", pdev->dev_name, path, std::strerror(-file)));
        return nullptr;
    }
    const std::uint64_t size = rtapi_pci_resource_len(pdev, bar);
    void *address = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    const int code = errno;
    ::close(file);
    if (address == MAP_FAILED) {
        complain(code,
                 fmt::format("PCI card {}: cannot map {}: {}", pdev->dev_name, path, std::strerror(code)));
        return nullptr;
    }
    resource.mapped = address;
    resource.mapped_size = size;
    return address;
}

void rtapi_iounmap(volatile void *addr) {
    const std::lock_guard lock(taken().mutex);
    for (rtapi_pci_dev *card : taken().cards) {
        for (rtapi_pci_resource &resource : card->resource) {
            if (addr != nullptr && resource.mapped == addr) {
                ::munmap(resource.mapped, resource.mapped_size);
                resource.mapped = nullptr;
            }
        }
    }
}

void rtapi_pci_set_drvdata(struct rtapi_pci_dev *pdev, void *data) {
    pdev->driver_data = data;
}

void *rtapi_pci_get_drvdata(struct rtapi_pci_dev *pdev) {
    return pdev->driver_data;
}

// ---- devices, firmware

int rtapi_dev_set_name(struct rtapi_device *dev, const char *name, ...) {
    std::va_list args;
    va_start(args, name);
    const int length = runtime::format_text(dev->name, sizeof dev->name, name, args);
    va_end(args);
    return length < static_cast<int>(sizeof dev->name) ? 0
                                                       : complain(EINVAL, "the name of a device is too long");
}

int rtapi_device_register(struct rtapi_device *) {
    return 0;
}

void rtapi_device_unregister(struct rtapi_device *dev) {
    if (dev->release != nullptr) {
        dev->release(dev);
    }
}

int rtapi_request_firmware(const struct rtapi_firmware **fw, const char *name, struct rtapi_device *device) {
    *fw = nullptr;
    std::vector<std::string> folders;
    if (const char *more = std::getenv("MILLWRIGHT_FIRMWARE")) {
        std::string_view rest = more;
        while (!rest.empty()) {
            folders.emplace_back(rest.substr(0, rest.find(':')));
            rest.remove_prefix(std::min(rest.size(), folders.back().size() + 1));
        }
    }
    folders.emplace_back("/lib/firmware");
    for (const std::string &folder : folders) {
        const auto bytes = read_file(folder + '/' + name);
        if (!bytes) {
            continue;
        }
        auto *found = static_cast<rtapi_firmware *>(std::malloc(sizeof(rtapi_firmware) + bytes->size()));
        if (found == nullptr) {
            return complain(ENOMEM, fmt::format("no memory for the firmware {}", name));
        }
        auto *data = reinterpret_cast<rtapi_u8 *>(found + 1);
        std::memcpy(data, bytes->data(), bytes->size());
        *found = {bytes->size(), data};
        *fw = found;
        return 0;
    }
    return complain(ENOENT,
                    fmt::format("device {}: there is no firmware {} in {}",
                                device == nullptr ? "?" : device->name, name, fmt::join(folders, ", ")));
}

void rtapi_release_firmware(const struct rtapi_firmware *fw) {
    std::free(const_cast<rtapi_firmware *>(fw));
}

}  // extern "C"
