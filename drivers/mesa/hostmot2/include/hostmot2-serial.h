/* SPDX-License-Identifier: GPL-2.0-or-later */
/* Serial interfaces of HostMot2 boards for other realtime components: UART, packet UART and buffered SPI.
 *
 * Load `hostmot2` and the component of the board first. The names of the interfaces are in the log, such as
 * hm2_7i80.0.uart.0. Functions whose text says "loading" belong into rtapi_app_main or EXTRA_SETUP; the
 * others into functions of the thread that calls the read and write functions of the board. Data travel with
 * the packets of the board: what is sent leaves with the next write, and what is received was in the last
 * read.
 *
 * Results below 0 are a negated errno: -ENODEV there is no such interface, -EINVAL an argument is outside its
 * range, -ENOSPC a queue is full.
 */
#ifndef HOSTMOT2_SERIAL_H
#define HOSTMOT2_SERIAL_H

#include "rtapi.h"

#ifdef __cplusplus
extern "C" {
#endif

/* UART. Modes are those of the registers; a negative mode leaves the register as it is. */
int hm2_uart_setup(const char *name, int bitrate, rtapi_s32 tx_mode, rtapi_s32 rx_mode);
/* Number of bytes that were queued: all or none. */
int hm2_uart_send(const char *name, const unsigned char data[], int count);
/* Number of bytes that were received, at most 16. */
int hm2_uart_read(const char *name, unsigned char data[]);

/* Packet UART. `txclear` and `rxclear` not 0 empty the FIFOs. */
int hm2_pktuart_setup(const char *name, int bitrate, rtapi_s32 tx_mode, rtapi_s32 rx_mode, int txclear,
                      int rxclear);
/* Empties all FIFOs and queues. */
int hm2_pktuart_reset(const char *name);
/* Sends *num_frames frames, whose bytes follow each other in data. *num_frames becomes the number of frames
 * that were queued. Number of bytes of them. */
int hm2_pktuart_send(const char *name, const unsigned char data[], rtapi_u8 *num_frames,
                     const rtapi_u16 frame_sizes[]);
/* Takes received frames, at most *num_frames (0: 16), while the next one has at most *max_frame_length bytes.
 * *num_frames becomes their number. Number of bytes in data. */
int hm2_pktuart_read(const char *name, unsigned char data[], rtapi_u8 *num_frames,
                     rtapi_u16 *max_frame_length, rtapi_u16 frame_sizes[]);
/* The sizes of received frames, at most 16; 0 after the last one. Their number. */
int hm2_pktuart_queue_get_frame_sizes(const char *name, rtapi_u32 fsizes[]);
/* Takes `bytes` of the oldest frames as words, low byte first; the last word of a frame is filled with 0.
 * Number of bytes. */
int hm2_pktuart_queue_read_data(const char *name, rtapi_u32 *data, int bytes);
/* Clock of the bit rate [Hz], version of the module. */
int hm2_pktuart_get_clock(const char *name);
int hm2_pktuart_get_version(const char *name);
/* The mode registers; bits 16 to 20 of the receiver count the frames that can be taken. */
rtapi_u32 hm2_pktuart_get_rx_status(const char *name);
rtapi_u32 hm2_pktuart_get_tx_status(const char *name);

/* Buffered SPI. Loading: describes a device. `cs` 0 to 15, `bits` 1 to 32, `delay` in ns. */
int hm2_bspi_setup_chan(const char *name, int chan, int cs, int bits, double mhz, int delay, int cpol,
                        int cpha, int noclear, int noecho, int samplelate);
/* Loading: prepares words of each cycle; always 0 here, since they are prepared already. */
int hm2_allocate_bspi_tram(const char *name);
/* Loading: *wbuff is sent in each cycle, and *rbuff has what the device returned. At most 16. */
int hm2_tram_add_bspi_frame(const char *name, int chan, rtapi_u32 **wbuff, rtapi_u32 **rbuff);
/* Sends one word with the next write; its echo is not stored. */
int hm2_bspi_write_chan(const char *name, int chan, rtapi_u32 val);
/* Loading: func is called after each read, or before each write of the board. */
int hm2_bspi_set_read_function(const char *name, int (*func)(void *subdata), void *subdata);
int hm2_bspi_set_write_function(const char *name, int (*func)(void *subdata), void *subdata);

#ifdef __cplusplus
}
#endif

#endif
