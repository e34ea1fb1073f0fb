/* SPDX-License-Identifier: GPL-2.0-or-later */
/* Serial interfaces of HostMot2 boards for other realtime components: UART, packet UART and buffered SPI.
 *
 * Load `hostmot2` and the component of the board first. The names of the interfaces are in the log, such as
 * hm2_7i80.0.uart.0. Call functions marked "Loading" in rtapi_app_main or EXTRA_SETUP, and the other
 * functions in the thread that calls the read and write functions of the board. Data are transferred with the
 * packets of the board: sent data leave with the next write, received data are from the last read.
 *
 * Results below 0 are a negated errno: -ENODEV there is no such interface, -EINVAL an argument is out of
 * range, -ENOSPC a queue is full. */
#ifndef HOSTMOT2_SERIAL_H
#define HOSTMOT2_SERIAL_H

#include "rtapi.h"

#ifdef __cplusplus
extern "C" {
#endif

/* UART. Modes are those of the registers; a negative mode does not change the register. */
int hm2_uart_setup(const char *name, int bitrate, rtapi_s32 tx_mode, rtapi_s32 rx_mode);
/* Returns the number of queued bytes: all or none. */
int hm2_uart_send(const char *name, const unsigned char data[], int count);
/* Returns the number of received bytes, at most 16. */
int hm2_uart_read(const char *name, unsigned char data[]);

/* Packet UART. `txclear` and `rxclear` not 0 empty the FIFOs. */
int hm2_pktuart_setup(const char *name, int bitrate, rtapi_s32 tx_mode, rtapi_s32 rx_mode, int txclear,
                      int rxclear);
/* Empties all FIFOs and queues. */
int hm2_pktuart_reset(const char *name);
/* Sends *num_frames frames, whose bytes follow each other in data. *num_frames becomes the number of queued
 * frames. Returns the number of their bytes. */
int hm2_pktuart_send(const char *name, const unsigned char data[], rtapi_u8 *num_frames,
                     const rtapi_u16 frame_sizes[]);
/* Reads received frames, at most *num_frames (0: 16), while the next one has at most *max_frame_length bytes.
 * *num_frames becomes their number. Returns the number of bytes in data. */
int hm2_pktuart_read(const char *name, unsigned char data[], rtapi_u8 *num_frames,
                     rtapi_u16 *max_frame_length, rtapi_u16 frame_sizes[]);
/* Writes the sizes of received frames, at most 16; 0 after the last one. Returns their number. */
int hm2_pktuart_queue_get_frame_sizes(const char *name, rtapi_u32 fsizes[]);
/* Reads `bytes` of the oldest frames as words, low byte first; the last word of a frame is padded with 0.
 * Returns the number of bytes. */
int hm2_pktuart_queue_read_data(const char *name, rtapi_u32 *data, int bytes);
/* Clock of the bit rate [Hz], version of the module. */
int hm2_pktuart_get_clock(const char *name);
int hm2_pktuart_get_version(const char *name);
/* The mode registers; bits 16 to 20 of the receiver are the number of frames that can be read. */
rtapi_u32 hm2_pktuart_get_rx_status(const char *name);
rtapi_u32 hm2_pktuart_get_tx_status(const char *name);

/* Buffered SPI. Loading: describes a device. `cs` 0 to 15, `bits` 1 to 32, `delay` in ns. */
int hm2_bspi_setup_chan(const char *name, int chan, int cs, int bits, double mhz, int delay, int cpol,
                        int cpha, int noclear, int noecho, int samplelate);
/* Loading: has no effect and returns 0, because the words of each cycle are already prepared. */
int hm2_allocate_bspi_tram(const char *name);
/* Loading: in each cycle *wbuff is sent, and *rbuff receives the answer of the device. At most 16. */
int hm2_tram_add_bspi_frame(const char *name, int chan, rtapi_u32 **wbuff, rtapi_u32 **rbuff);
/* Sends one word with the next write; its echo is not stored. */
int hm2_bspi_write_chan(const char *name, int chan, rtapi_u32 val);
/* Loading: func is called after each read, or before each write, of the board. */
int hm2_bspi_set_read_function(const char *name, int (*func)(void *subdata), void *subdata);
int hm2_bspi_set_write_function(const char *name, int (*func)(void *subdata), void *subdata);

#ifdef __cplusplus
}
#endif

#endif
