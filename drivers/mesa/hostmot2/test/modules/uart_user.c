// SPDX-License-Identifier: GPL-2.0-or-later
// uart_user: a component that sends three bytes in each cycle through a UART of a board.
#include "hal.h"
#include "hostmot2-serial.h"
#include "rtapi.h"
#include "rtapi_app.h"

static char *name = "";
RTAPI_MP_STRING(name, "name of the UART");

static int comp_id = -1;
static struct {
    hal_s32_t *sent, *received;
} *pins;

static void run(void *unused, long period) {
    static const unsigned char data[] = {1, 2, 3};
    unsigned char bytes[16];
    (void)unused;
    (void)period;
    *pins->sent = hm2_uart_send(name, data, sizeof(data));
    *pins->received = hm2_uart_read(name, bytes);
}

int rtapi_app_main(void) {
    int status = hm2_uart_setup(name, 115200, -1, -1);
    if (status < 0) {
        return status;
    }
    comp_id = hal_init("uart_user");
    pins = hal_malloc(sizeof(*pins));
    if (comp_id < 0 || pins == 0) {
        return -1;
    }
    status = hal_pin_s32_newf(HAL_OUT, &pins->sent, comp_id, "uart-user.sent");
    status = status < 0 ? status : hal_pin_s32_newf(HAL_OUT, &pins->received, comp_id, "uart-user.received");
    status = status < 0 ? status : hal_export_funct("uart-user", run, 0, 0, 0, comp_id);
    return status < 0 ? status : hal_ready(comp_id);
}

void rtapi_app_exit(void) {
    hal_exit(comp_id);
}
