/* SPDX-License-Identifier: GPL-2.0-or-later */
/* PCI cards, accessed through /sys/bus/pci. The process must have write access (root, or rules for the card).
 * For set-up code; the mapped registers are for realtime functions. */
#ifndef RTAPI_PCI_H
#define RTAPI_PCI_H

#include "rtapi_device.h"
#include "rtapi_stdint.h"

#ifdef __cplusplus
extern "C" {
#endif

#define RTAPI_PCI_ANY_ID 0xffffffffU
#define RTAPI_PCI_BARS 6

/* Cards that a driver supports; a table ends with an entry of zeros. */
struct rtapi_pci_device_id {
    rtapi_u32 vendor, device;
    rtapi_u32 subvendor, subdevice;
#ifdef __cplusplus
    rtapi_u32 class_, class_mask;
#else
    rtapi_u32 class, class_mask;
#endif
    unsigned long driver_data;
};

struct rtapi_pci_resource {
    rtapi_u64 start, end; /* both 0 if there is none */
    unsigned long flags;  /* bit 8: ports, bit 9: memory */
    void *mapped;
    rtapi_u64 mapped_size;
};

struct rtapi_pci_dev {
    char dev_name[32]; /* "0000:01:00.0" */
    rtapi_u16 vendor, device;
    rtapi_u16 subsystem_vendor, subsystem_device;
    rtapi_u8 revision;
    unsigned int irq;
    struct rtapi_pci_resource resource[RTAPI_PCI_BARS];
    struct rtapi_device dev;
    void *driver_data;
    struct rtapi_pci_driver *driver;
    struct rtapi_pci_dev *next;
};

struct rtapi_pci_driver {
    const char *name;
    const struct rtapi_pci_device_id *id_table;
    /* Returns 0 to claim the card. */
    int (*probe)(struct rtapi_pci_dev *dev, const struct rtapi_pci_device_id *id);
    void (*remove)(struct rtapi_pci_dev *dev);
    struct rtapi_pci_dev *devices; /* claimed cards */
};

/* NOLINTNEXTLINE(bugprone-reserved-identifier): existing code names it so */
#define rtapi__iomem volatile

extern const char *rtapi_pci_name(const struct rtapi_pci_dev *pdev);
/* Calls probe for every card in the computer that matches the table. Returns 0 (also without a card), or a
 * negated errno. */
extern int rtapi_pci_register_driver(struct rtapi_pci_driver *driver);
/* Calls remove for the claimed cards, and releases them. */
extern void rtapi_pci_unregister_driver(struct rtapi_pci_driver *driver);
/* Returns 0, or a negated errno with a message. */
extern int rtapi_pci_enable_device(struct rtapi_pci_dev *dev);
extern int rtapi_pci_disable_device(struct rtapi_pci_dev *dev);
/* Maps a card's registers. Returns NULL with a message on failure. */
extern void rtapi__iomem *rtapi_pci_ioremap_bar(struct rtapi_pci_dev *pdev, int bar);
extern void rtapi_iounmap(volatile void *addr);
extern void rtapi_pci_set_drvdata(struct rtapi_pci_dev *pdev, void *data);
extern void *rtapi_pci_get_drvdata(struct rtapi_pci_dev *pdev);

#define rtapi_pci_resource_start(dev, bar) ((dev)->resource[(bar)].start)
#define rtapi_pci_resource_end(dev, bar) ((dev)->resource[(bar)].end)
#define rtapi_pci_resource_flags(dev, bar) ((dev)->resource[(bar)].flags)
#define rtapi_pci_resource_len(dev, bar)                                                                     \
    (rtapi_pci_resource_end(dev, bar) == 0                                                                   \
         ? 0                                                                                                 \
         : rtapi_pci_resource_end(dev, bar) - rtapi_pci_resource_start(dev, bar) + 1)

#ifdef __cplusplus
}
#endif

#endif
