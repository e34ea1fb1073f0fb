component serialport "sends and receives bytes by a UART of a board; names= has the UARTs";
pin in u32 tx-data-##[16] "bytes to send";
pin in s32 tx-bytes "number of them";
pin out u32 rx-data-##[16] "bytes that were received";
pin out s32 rx-bytes "number of them";
pin in u32 word "for a device on buffered SPI";
variable int is_spi;
option singleton no;
option extra_setup yes;
function send nofp;
function receive nofp;
license "GPL";
author "the authors of Millwright";
;;
#include "rtapi_string.h"
#include "hostmot2-serial.h"

static char port[16][HAL_NAME_LEN + 1];
static int ports;

static int prepare_spi(const char *name) {
    rtapi_u32 *sent, *received;
    int status = hm2_bspi_setup_chan(name, 0, 0, 32, 2.5, 0, 0, 0, 1, 0, 0);
    status = status < 0 ? status : hm2_tram_add_bspi_frame(name, 0, &sent, &received);
    status = status < 0 ? status : hm2_allocate_bspi_tram((char *)name);
    return status < 0 ? status : hm2_bspi_set_write_function(name, NULL, NULL);
}

static int prepare_packets(char *name) {
    rtapi_u8 frames = 1;
    rtapi_u16 size = 4, sizes[16] = {4};
    rtapi_u32 all[16];
    unsigned char data[4] = {1, 2, 3, 4};
    int status = hm2_pktuart_setup(name, 115200, 0x8, 0x3F, 1, 1);
    status = status < 0 ? status : hm2_pktuart_send(name, data, &frames, sizes);
    status = status < 0 ? status : hm2_pktuart_read(name, data, &frames, &size, sizes);
    status = status < 0 ? status : hm2_pktuart_queue_get_frame_sizes(name, all);
    return status < 0 ? status : hm2_pktuart_reset(name);
}

EXTRA_SETUP() {
    int status;
    rtapi_snprintf(port[ports], sizeof(port[0]), "%s", prefix);
    is_spi = strstr(prefix, "bspi") != NULL;
    if (is_spi) {
        status = prepare_spi(port[ports]);
    } else if (strstr(prefix, "pktuart") != NULL) {
        status = prepare_packets(port[ports]);
    } else {
        status = hm2_uart_setup(port[ports], 115200, -1, -1);
    }
    if (status < 0) {
        rtapi_print_msg(RTAPI_MSG_ERR, "serialport: there is no interface %s\n", prefix);
        return status;
    }
    ports++;
    return extra_arg < 0 ? -1 : 0;
}

FUNCTION(send) {
    unsigned char data[16];
    int i;
    for (i = 0; i < 16; i++) {
        data[i] = tx_data(i) & 0xFF;
    }
    hm2_uart_send(port[0], data, tx_bytes);
    if (is_spi) {
        hm2_bspi_write_chan(port[0], 0, word);
    }
}

FUNCTION(receive) {
    unsigned char data[16];
    int i;
    rx_bytes = hm2_uart_read(port[0], data);
    for (i = 0; i < rx_bytes && i < 16; i++) {
        rx_data(i) = data[i];
    }
}
