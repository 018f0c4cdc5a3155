"""Independent writers of binary logs: MCAP by mcap.dev/spec, CDR by OMG DDS-XTypes 1.3, bags by the tables of
rosbag2_storage_sqlite3, HDF5 by h5py, .npy and .npz by NumPy."""

import math
import sqlite3
import struct
import subprocess
import zlib

JOINT_STATE = 'sensor_msgs/msg/JointState'
DEFINITION = 'std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n'
START_NS = 1_760_000_000_123_456_789


def motion(k, rate=500.0):
    """rad, rad/s, Nm at sample k: two sines, an inertia, viscous and dry friction."""
    t = k / rate
    x = v = a = 0.0
    for amplitude, f in ((1.2, 0.31), (0.2, 1.7)):
        w = 2 * math.pi * f
        x += amplitude * math.sin(w * t)
        v += amplitude * w * math.cos(w * t)
        a -= amplitude * w * w * math.sin(w * t)
    return x, v, 0.05 * a + 0.1 * v + (0.4 if v > 0 else -0.4)


class Cdr:
    """Plain CDR: numbers aligned to their size after the encapsulation header."""

    def __init__(self, big=False):
        self.order = '>' if big else '<'
        self.body = bytearray()

    def number(self, kind, value):
        size = struct.calcsize(kind)
        self.body += b'\0' * (-len(self.body) % size) + struct.pack(self.order + kind, value)

    def text(self, text):
        raw = text.encode() + b'\0'
        self.number('I', len(raw))
        self.body += raw

    def doubles(self, values):
        self.number('I', len(values))
        for value in values:
            self.number('d', value)

    def message(self):
        return (b'\0\0\0\0' if self.order == '>' else b'\0\1\0\0') + bytes(self.body)


def joint_state(stamp_ns, names, positions, velocities, efforts, big=False, frame=''):
    cdr = Cdr(big)
    cdr.number('i', stamp_ns // 10**9)
    cdr.number('I', stamp_ns % 10**9)
    cdr.text(frame)
    cdr.number('I', len(names))
    for name in names:
        cdr.text(name)
    for values in (positions, velocities, efforts):
        cdr.doubles(values)
    return cdr.message()


def messages(names=('joint1',), rows=2000, rate=500.0, big=False, stamped=True, scale=1.0, sign=1.0):
    """(time of recording, message) of joints with the same motion, each with half the amplitude of the previous one."""
    out = []
    for k in range(rows):
        x, v, m = motion(k, rate)
        stamp = START_NS + round(1e9 * k / rate)
        share = [sign * 0.5 ** j for j in range(len(names))]
        out.append((stamp + 40_000 if stamped else stamp,
                    joint_state(stamp if stamped else 0, names, [scale * s * x for s in share],
                                [scale * s * v for s in share], [s * m for s in share], big)))
    return out


def record(opcode, body):
    return struct.pack('<BQ', opcode, len(body)) + body


def text(value):
    raw = value.encode()
    return struct.pack('<I', len(raw)) + raw


def packed(data, packing):
    if not packing:
        return data
    tool = {'lz4': ['lz4', '-c', '-z'], 'zstd': ['zstd', '-c', '-q']}[packing]
    return subprocess.run(tool, input=data, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=True).stdout


def mcap(path, topics, packing='', chunked=True, schema=JOINT_STATE, per_chunk=400, ended=True, checked=True):
    """topics: {name: [(time, message)]}"""
    heads = record(3, struct.pack('<H', 1) + text(schema) + text('ros2msg') + text(DEFINITION))
    for number, name in enumerate(topics):
        qos = text('offered_qos_profiles') + text('')
        heads += record(4, struct.pack('<HH', number + 1, 1) + text(name) + text('cdr') + struct.pack('<I', len(qos)) + qos)
    rows = sorted((time, number + 1, data) for number, name in enumerate(topics) for time, data in topics[name])
    records = [record(5, struct.pack('<HIQQ', number, k, time, time) + data) for k, (time, number, data) in enumerate(rows)]
    out = b'\x89MCAP0\r\n' + record(1, text('ros2') + text('a test'))
    if not chunked:
        out += heads + b''.join(records)
    for k in range(0, len(records) if chunked else 0, per_chunk):
        plain = (heads if k == 0 else b'') + b''.join(records[k:k + per_chunk])
        inner = packed(plain, packing)
        out += record(6, struct.pack('<QQQI', rows[k][0], rows[min(k + per_chunk, len(rows)) - 1][0], len(plain),
                                     zlib.crc32(plain) if checked else 0) + text(packing) + struct.pack('<Q', len(inner)) + inner)
        out += record(7, struct.pack('<HI', 1, 0))
    if ended:
        out += record(15, struct.pack('<I', 0)) + record(2, struct.pack('<QQI', 0, 0, 0)) + b'\x89MCAP0\r\n'
    with open(path, 'wb') as file:
        file.write(out)


def bag(path, topics, kind=JOINT_STATE):
    base = sqlite3.connect(path)
    base.execute('CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, '
                 'serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL)')
    base.execute('CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL, '
                 'data BLOB NOT NULL)')
    base.execute('CREATE INDEX timestamp_idx ON messages (timestamp ASC)')
    for number, name in enumerate(topics):
        base.execute('INSERT INTO topics VALUES (?, ?, ?, ?, ?)', (number + 1, name, kind, 'cdr', ''))
        base.executemany('INSERT INTO messages (topic_id, timestamp, data) VALUES (?, ?, ?)',
                         [(number + 1, time, data) for time, data in topics[name]])
    base.commit()
    base.close()


FLAGS = ['flightModeFlags (flags)', 'stateFlags (flags)', 'failsafePhase (flags)']
FIELDS = (['loopIteration', 'time'] + [f'axis{term}[{k}]' for term in 'PID' for k in range(3)] + ['axisF[0]'] +
          [f'rcCommand[{k}]' for k in range(4)] + [f'setpoint[{k}]' for k in range(4)] +
          ['vbatLatest', 'amperageLatest', 'rssi'] + [f'gyroADC[{k}]' for k in range(3)] +
          [f'accSmooth[{k}]' for k in range(3)] + [f'debug[{k}]' for k in range(4)] + [f'motor[{k}]' for k in range(4)])


def flight(k, period_us):
    """One frame of a flight controller, in the order of FIELDS; voltage and current in V and A."""
    rates = [round(200 * math.sin(0.003 * k * (axis + 1))) for axis in range(3)]
    throttle = 1300 + round(100 * math.sin(0.002 * k))
    return ([52992 + k, 55158008 + round(k * period_us)] + [round(0.2 * r) for r in rates] + [round(0.1 * r) for r in rates] +
            [k % 7 - 3 for _ in range(3)] + [0] + [r // 2 for r in rates] + [throttle] + rates + [throttle - 1000] +
            [15.8 - 0.0001 * k, 8.0 + 4.0 * math.sin(0.004 * k), 1023] + [r - k % 5 for r in rates] + [10, -20, 2048] +
            [k % 11, 0, 0, 0] + [throttle + r // 10 for r in rates] + [throttle])


def blackbox_decode(path, period_us, rows=3000):
    """As github.com/betaflight/blackbox-tools writes it."""
    units = {'time': 'time (us)', 'vbatLatest': 'vbatLatest (V)', 'amperageLatest': 'amperageLatest (A)'}
    names = [units.get(name, name) for name in FIELDS] + ['energyCumulative (mAh)'] + FLAGS + ['rxSignalReceived']
    lines = [', '.join(names)]
    for k in range(rows):
        values = ['%.3f' % v if isinstance(v, float) else str(v) for v in flight(k, period_us)]
        lines.append(', '.join(values + [str(k // 200), 'ANGLE_MODE|HORIZON_MODE' if k > 500 else '0', 'SMALL_ANGLE', 'IDLE', '1']))
    with open(path, 'w') as file:
        file.write('\n'.join(lines) + '\n')


def blackbox_explorer(path, period_us, rows=3000):
    """As the CSV export of github.com/betaflight/blackbox-log-viewer writes it: the header of the log comes first."""
    def quoted(values):
        return ','.join(str(v) if isinstance(v, (int, float)) else f'"{v}"' for v in values)

    head = [('Product', 'Blackbox flight data recorder by Nicholas Sherlock'), ('firmwareType', 3), ('I interval', 32),
            ('Firmware revision', 'Betaflight 4.4.2 (23d066d08) STM32F405'), ('minthrottle', 1070), ('gyroScale', 1.0),
            ('looptime', 125), ('rollPID', '45,80,40'), ('vbatcellvoltage', '330,350,430'), ('craftName', ''),
            ('rates', '67,67,67'), ('motorOutput', '158,2047')] + [(f'field{k}', k) for k in range(60)]
    lines = [quoted(row) for row in head] + [quoted(FIELDS + ['flightModeFlags', 'heading[0]'])]
    lines += [','.join(str(v) for v in flight(k, period_us) + ['NaN' if k < 30 else 3, 0.1]) for k in range(rows)]
    with open(path, 'w') as file:
        file.write('\n'.join(lines) + '\n')


def mat5(path, variables, compressed=False):
    """MAT-file of level 5 (MAT-File Format, chapter 1) with real columns; `compressed` as save -v7 does."""
    def element(kind, data):
        return struct.pack('<II', kind, len(data)) + data + b'\0' * (-len(data) % 8)

    out = b'MATLAB 5.0 MAT-file, a test'.ljust(124) + struct.pack('<H', 0x0100) + b'IM'
    for name, values in variables.items():
        body = (element(6, struct.pack('<II', 6, 0)) + element(5, struct.pack('<ii', len(values), 1)) +
                element(1, name.encode()) + element(9, struct.pack(f'<{len(values)}d', *values)))
        matrix = struct.pack('<II', 14, len(body)) + body
        if compressed:
            inner = zlib.compress(matrix)
            matrix = struct.pack('<II', 15, len(inner)) + inner
        out += matrix
    with open(path, 'wb') as file:
        file.write(out)


def mat73(path, variables):
    """As save -v7.3 writes it: HDF5 after a header of 512 bytes."""
    import h5py
    import numpy
    with h5py.File(path, 'w', userblock_size=512) as file:
        for name, values in variables.items():
            file.create_dataset(name, data=[values], compression='gzip').attrs['MATLAB_class'] = numpy.bytes_('double')
    with open(path, 'r+b') as file:
        file.write(b'MATLAB 7.3 MAT-file, a test'.ljust(124) + struct.pack('<H', 0x0200) + b'IM')
