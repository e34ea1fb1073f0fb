#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""import hal, pyhal against a realtime process (requirement B5). usage: hal_test.py HALRUN"""
import errno
import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest


class ComponentTest(unittest.TestCase):
    def setUp(self):
        self.comp = hal.component("pytest")

    def tearDown(self):
        if not self.comp.name == "gone":
            try:
                self.comp.exit()
            except hal.error:
                pass

    def test_values_of_all_types_come_back(self):
        for name, kind, value in (("b", hal.HAL_BIT, True), ("f", hal.HAL_FLOAT, 2.5), ("s", hal.HAL_S32, -2**31),
                                  ("u", hal.HAL_U32, 2**32 - 1), ("l", hal.HAL_S64, -2**63),
                                  ("k", hal.HAL_U64, 2**64 - 1)):
            pin = self.comp.newpin(name, kind, hal.HAL_OUT)
            self.comp[name] = value
            self.assertEqual(self.comp[name], value)
            self.assertIs(type(self.comp[name]), type(value))
            self.assertEqual(pin.get(), value)
            self.assertEqual(hal.get_value("pytest." + name), value)

    def test_numbers_that_do_not_fit_are_refused(self):
        self.comp.newpin("s", hal.HAL_S32, hal.HAL_OUT)
        self.comp.newpin("u", hal.HAL_U32, hal.HAL_OUT)
        self.comp.newpin("f", hal.HAL_FLOAT, hal.HAL_OUT)
        for name, value, error in (("s", 2**31, OverflowError), ("s", -2**31 - 1, OverflowError),
                                   ("u", -1, OverflowError), ("u", 2**32, OverflowError), ("s", "x", ValueError),
                                   ("f", 2**1024, OverflowError), ("f", "x", TypeError)):
            with self.assertRaises(error, msg=f"{name}={value}"):
                self.comp[name] = value
        self.comp["s"] = 1.5
        self.assertEqual(self.comp["s"], 1)
        self.comp["f"] = 2**1023
        self.assertEqual(self.comp["f"], float(2**1023))

    def test_items_tell_about_themselves(self):
        pin = self.comp.newpin("a", hal.HAL_FLOAT, hal.HAL_IN)
        param = self.comp.newparam("p", hal.HAL_U32, hal.HAL_RW)
        self.assertEqual((pin.get_name(), pin.get_type(), pin.get_dir(), pin.is_pin()),
                         ("a", hal.HAL_FLOAT, hal.HAL_IN, True))
        self.assertEqual((param.name, param.type, param.dir, param.is_pin()), ("p", hal.HAL_U32, hal.HAL_RW, False))
        pin.value = 7
        self.assertEqual(pin.value, 7.0)
        self.assertEqual(self.comp.getpins(), {"a": 7.0, "p": 0})
        self.assertEqual(len(self.comp), 2)
        self.assertEqual(repr(self.comp.getparam("p")), '<hal param "p" U32-RW>')
        self.assertEqual(self.comp.getpin("a").get(), 7.0)
        with self.assertRaises(AttributeError):
            self.comp.getpin("p")
        with self.assertRaises(AttributeError):
            self.comp.getitem("zz")

    def test_names_are_attributes_where_python_allows(self):
        self.comp.newpin("speed", hal.HAL_S32, hal.HAL_OUT)
        self.comp.speed = 5
        self.assertEqual(self.comp.speed, 5)
        with self.assertRaises(AttributeError):
            self.comp.nonesuch
        with self.assertRaises(AttributeError):
            self.comp.nonesuch = 1

    def test_bad_pins_are_refused(self):
        self.comp.newpin("a", hal.HAL_FLOAT, hal.HAL_IN)
        with self.assertRaises(ValueError):
            self.comp.newpin("a", hal.HAL_FLOAT, hal.HAL_IN)
        with self.assertRaises(hal.error):
            self.comp.newpin("x", 99, hal.HAL_IN)
        with self.assertRaises(hal.error):
            self.comp.newpin("x", hal.HAL_BIT, 99)
        with self.assertRaises(hal.error):
            self.comp.newparam("x", hal.HAL_BIT, hal.HAL_IN)
        with self.assertRaises(hal.error):
            hal.component("pytest")

    def test_pins_come_before_ready_or_after_unready(self):
        self.comp.ready()
        self.assertTrue(hal.component_is_ready("pytest"))
        with self.assertRaises(hal.error):
            self.comp.newpin("late", hal.HAL_BIT, hal.HAL_IN)
        self.comp.unready()
        self.comp.newpin("late", hal.HAL_BIT, hal.HAL_IN)
        self.comp.ready()

    def test_prefix_changes_names(self):
        self.comp.setprefix("other.place")
        self.comp.newpin("a", hal.HAL_BIT, hal.HAL_IN)
        self.assertEqual(self.comp.getprefix(), "other.place")
        self.assertFalse(hal.get_value("other.place.a"))

    def test_end_of_component_ends_its_pins(self):
        pin = self.comp.newpin("a", hal.HAL_FLOAT, hal.HAL_IN)
        self.comp.exit()
        self.assertFalse(hal.component_exists("pytest"))
        with self.assertRaises(hal.error):
            pin.get()
        with self.assertRaises(hal.error):
            self.comp.newpin("b", hal.HAL_BIT, hal.HAL_IN)


class FunctionsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.comp = hal.component("pyfunc")
        cls.comp.newpin("in", hal.HAL_FLOAT, hal.HAL_IN)
        cls.comp.newpin("out", hal.HAL_FLOAT, hal.HAL_OUT)
        cls.comp.newpin("bit", hal.HAL_BIT, hal.HAL_IN)
        cls.comp.newparam("count", hal.HAL_U32, hal.HAL_RW)
        cls.comp.ready()

    @classmethod
    def tearDownClass(cls):
        cls.comp.exit()

    def test_signals_link_pins(self):
        self.assertTrue(hal.new_sig("wire", hal.HAL_FLOAT))
        self.assertFalse(hal.new_sig("wire", hal.HAL_FLOAT))
        self.assertTrue(hal.connect("pyfunc.in", "wire"))
        self.assertFalse(hal.pin_has_writer("pyfunc.in"))
        self.assertFalse(hal.connect("pyfunc.bit", "wire"))
        hal.set_s("wire", 1.5)
        self.assertEqual(self.comp["in"], 1.5)
        self.assertTrue(hal.connect("pyfunc.out", "wire"))
        self.assertTrue(hal.pin_has_writer("pyfunc.in"))
        with self.assertRaises(RuntimeError):
            hal.set_s("wire", 2.5)
        self.comp["out"] = 4.5
        self.assertEqual(hal.get_s("wire"), 4.5)
        driver = [row["DRIVER"] for row in hal.get_info_signals() if row["NAME"] == "wire"]
        self.assertEqual(driver, ["pyfunc.out"])
        self.assertTrue(hal.disconnect("pyfunc.in"))
        self.assertTrue(hal.disconnect("pyfunc.out"))
        with self.assertRaises(NameError):
            hal.pin_has_writer("no.such")

    def test_set_p_takes_text_and_numbers(self):
        for value, expected in (("3", 3), (4, 4), ("0x10", 16)):
            hal.set_p("pyfunc.count", value)
            self.assertEqual(hal.get_p("pyfunc.count"), expected)
        for value, expected in (("on", True), ("NO", False), (True, True), (0, False), ("yes", True)):
            hal.set_p("pyfunc.bit", value)
            self.assertEqual(hal.get_value("pyfunc.bit"), expected)
        for name, value in (("pyfunc.count", "x"), ("pyfunc.out", "1"), ("no.such", "1")):
            with self.assertRaises(RuntimeError, msg=name):
                hal.set_p(name, value)
        with self.assertRaises(RuntimeError):
            hal.get_value("no.such")

    def test_lists_name_everything(self):
        pins = {row["NAME"]: row for row in hal.get_info_pins()}
        self.assertEqual(pins["pyfunc.out"]["DIRECTION"], hal.HAL_OUT)
        self.assertEqual(pins["pyfunc.out"]["TYPE"], hal.HAL_FLOAT)
        self.assertIn("pyfunc.count", [row["NAME"] for row in hal.get_info_params()])

    def test_query(self):
        pin = hal.query.pin("pyfunc.out")
        self.assertEqual((pin["type"], pin["dir"], pin["comp"]),
                         (hal.query.Type.REAL, hal.query.Dir.OUT, "pyfunc"))
        self.assertEqual(repr(hal.query.Type(6)), "<Type.SINT: 6>")
        self.assertEqual(hal.query.comp("and2")["type"], hal.query.CompType.REALTIME)
        self.assertEqual(hal.query.comp(hal.query.comp("and2")["id"])["name"], "and2")
        ids = [row["id"] for row in hal.query.comps().values()]
        self.assertEqual(ids, sorted(ids, reverse=True))
        self.assertEqual([row["name"] for row in hal.query.thread("servo")["functions"]], ["and2.0", "raster.0"])
        self.assertEqual(hal.query.thread("servo")["comp"], "__servo")
        self.assertEqual(hal.query.funct("and2.0")["users"], 1)
        self.assertEqual(list(hal.query.pins("and2.0.in*")), ["and2.0.in0", "and2.0.in1"])
        self.assertEqual(list(hal.query.pin("and2.0.in0")),
                         ["haltype", "name", "type", "dir", "value", "alias", "signal", "comp", "comp_id"])
        self.assertIn("and2.0.out", hal.query.signalpins("both"))
        self.assertEqual(hal.query.signal("both")["driver"], "and2.0.out")
        for one in (hal.query.pin, hal.query.param, hal.query.signal, hal.query.comp, hal.query.funct,
                    hal.query.thread, hal.query.signalpins):
            self.assertIsNone(one("nosuch"))

    def test_message_level(self):
        before = hal.get_msg_level()
        hal.set_msg_level(hal.MSG_WARN)
        self.assertEqual(hal.get_msg_level(), hal.MSG_WARN)
        hal.set_msg_level(before)
        with self.assertRaises(RuntimeError):
            hal.set_msg_level(9)


class StreamTest(unittest.TestCase):
    def setUp(self):
        self.comp = hal.component("pystream")

    def tearDown(self):
        self.comp.exit()

    def test_records_pass_in_order_until_full(self):
        stream = hal.stream(self.comp, hal.sampler_base + 5, 3, "bfsulk")
        self.assertFalse(stream.readable)
        self.assertIsNone(stream.read())
        rows = [(True, 2.5, -3, 4, -5, 6), (False, -1.0, 0, 1, 2, 3)]
        for row in rows:
            stream.write(row)
        self.assertFalse(stream.writable)
        with self.assertRaises(OSError):
            stream.write(rows[0])
        reader = hal.stream(self.comp, hal.sampler_base + 5, "bfsulk")
        self.assertEqual([reader.read(), reader.read()], rows)
        self.assertEqual((stream.num_overruns, stream.num_underruns, reader.sampleno), (1, 1, 2))
        self.assertEqual((stream.maxdepth, stream.element_types), (3, b"bfsulk"))

    def test_a_stream_holds_one_record_less_than_its_depth(self):
        for depth, held in ((1, 1), (2, 1), (3, 2), (10, 9)):
            with self.subTest(depth=depth):
                stream = hal.stream(self.comp, hal.sampler_base + 7 + depth, depth, "s")
                count = 0
                while stream.writable:
                    stream.write((count,))
                    count += 1
                self.assertEqual((count, stream.depth, stream.maxdepth), (held, held, depth))

    def test_a_stream_that_does_not_exist_is_an_invalid_argument(self):
        for types in ((), ("bf",)):
            with self.assertRaises(OSError) as error:
                hal.stream(self.comp, hal.sampler_base + 60, *types)
            self.assertEqual(error.exception.errno, errno.EINVAL)

    def test_rows_are_tuples_or_lists(self):
        stream = hal.stream(self.comp, hal.sampler_base + 61, 5, "bs")
        for row in ((1, 2), [1, 2]):
            stream.write(row)
            self.assertEqual(stream.read(), (True, 2))
        for row in (None, 5, iter((1, 2))):
            with self.assertRaises(TypeError):
                stream.write(row)

    def test_wrong_types_are_refused(self):
        with self.assertRaises(OSError):
            hal.stream(self.comp, hal.sampler_base + 6, 10, "bz")
        stream = hal.stream(self.comp, hal.sampler_base + 6, 10, "bs")
        with self.assertRaises(OSError):
            hal.stream(self.comp, hal.sampler_base + 6, "ff")
        for row, error in (((True,), ValueError), ((True, "x"), ValueError), ((True, 2**31), OverflowError)):
            with self.assertRaises(error):
                stream.write(row)

    def test_shared_memory_is_one_block(self):
        first = hal.shm(self.comp, 4711, 100)
        first.getbuffer()[3] = 42
        self.assertEqual(memoryview(hal.shm(self.comp, 4711, 100))[3], 42)
        self.assertEqual(len(first), 100)


class PortTest(unittest.TestCase):
    def test_bytes_pass_through_a_port(self):
        comp = pyhal.component("pyport")
        writer = comp.pinNew("w", pyhal.halType.PORT, pyhal.pinDir.OUT)
        reader = comp.pinNew("r", pyhal.halType.PORT, pyhal.pinDir.IN)
        comp.ready()
        comp.sigNew("pipe", pyhal.halType.PORT)
        comp.sigLink(writer, "pipe")
        comp.sigLink("pyport.r", "pipe")
        self.assertEqual((writer.size(), writer.writable()), (0, 0))
        self.assertFalse(writer.waitWritable(1, timeout=0.01))
        hal.set_s("pipe", 8)
        self.assertTrue(writer.waitWritable(7, timeout=0))
        self.assertEqual(writer.writable(), 7)
        self.assertTrue(writer.write(b"abcde"))
        self.assertFalse(writer.write("xyz"))
        self.assertEqual(reader.peek(2), b"ab")
        self.assertFalse(reader.read(6))
        self.assertEqual(reader.read(5), b"abcde")
        self.assertEqual(reader.readable(), 0)
        comp.exit()


class RasterTest(unittest.TestCase):
    def test_a_line_reaches_the_component(self):
        programmer = raster.RasterProgrammer("pyraster")
        hal.new_sig("lines", hal.HAL_PORT)
        for pin in ("pyraster.program", "raster.0.program"):
            self.assertTrue(hal.connect(pin, "lines"))
        hal.set_s("lines", 512)
        programmer.begin(0, 8, 10, 3, timeout=5)
        with self.assertRaises(ValueError):
            programmer.data([256])
        programmer.data("0080", timeout=5)
        programmer.data([255], timeout=5)
        end = time.monotonic() + 10
        while hal.get_value("raster.0.state") != 3 and time.monotonic() < end:
            time.sleep(0.002)
        self.assertEqual(hal.get_value("raster.0.state"), 3)
        self.assertEqual(hal.get_value("raster.0.fault-code"), raster.FaultCodes.NONE)
        programmer.exit()


class UnloadTest(unittest.TestCase):
    def test_unload_comes_as_keyboard_interrupt(self):
        code = ("import hal, time\nc = hal.component('stopme')\nc.ready()\n"
                "try:\n    time.sleep(20)\nexcept KeyboardInterrupt:\n    raise SystemExit(7)\n")
        with subprocess.Popen([sys.executable, "-c", code]) as child:
            end = time.monotonic() + 10
            while not hal.component_is_ready("stopme") and time.monotonic() < end:
                time.sleep(0.005)
            child.send_signal(signal.SIGTERM)
            self.assertEqual(child.wait(10), 7)

    def test_a_program_that_swallows_the_interrupt_ends_and_leaves_hal(self):
        code = ("import hal, time\nh = hal.component('deaf')\nh.ready()\n"
                "while True:\n    try:\n        time.sleep(20)\n    except KeyboardInterrupt:\n        pass\n")
        with subprocess.Popen([sys.executable, "-c", code]) as child:
            end = time.monotonic() + 10
            while not hal.component_is_ready("deaf") and time.monotonic() < end:
                time.sleep(0.005)
            child.send_signal(signal.SIGTERM)
            self.assertEqual(child.wait(10), -signal.SIGTERM)
        self.assertFalse(hal.component_exists("deaf"))

    def test_a_program_that_ends_in_order_leaves_hal(self):
        code = "import hal\nh = hal.component('brief')\nh.newpin('p', hal.HAL_BIT, hal.HAL_OUT)\nh.ready()\n"
        self.assertEqual(subprocess.run([sys.executable, "-c", code], check=False).returncode, 0)
        self.assertFalse(hal.component_exists("brief"))


HAL_FILE = """
loadrt threads name1=servo period1=1000000
loadrt and2
addf and2.0 servo
loadrt raster
addf raster.0 servo
net both and2.0.out
start
loadusr -w {python} {script} --inside
"""


def main():
    if sys.argv[1] == "--inside":
        unittest.main(argv=sys.argv[:1])
    with tempfile.TemporaryDirectory() as folder:
        hal_file = os.path.join(folder, "test.hal")
        with open(hal_file, "w", encoding="utf-8") as out:
            out.write(HAL_FILE.format(python=sys.executable, script=os.path.abspath(__file__)))
        env = dict(os.environ, MILLWRIGHT_INSTANCE=f"py{os.getpid()}", XDG_RUNTIME_DIR=folder)
        return subprocess.run([sys.argv[1], "-f", hal_file], env=env, check=False).returncode


if __name__ == "__main__":
    if "--inside" in sys.argv:
        import hal
        import pyhal
        import raster
    sys.exit(main())
