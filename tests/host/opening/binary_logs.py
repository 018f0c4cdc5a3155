#!/usr/bin/env python3
"""Binary logs and logs of flight controllers, from independent writers (log_files.py): binary_logs.py AXISTOOL

Every channel must be read with its values, its unit and the period of its rows. The program must ask for information
that the file lacks."""

import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import log_files as made

try:
    import h5py
    import numpy
except ImportError:
    h5py = None

PROGRAM = sys.argv.pop(1)
ROWS = 2000


class BinaryLogs(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def run_tool(self, *arguments):
        return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True)

    def open(self, path, *arguments):
        """The JSON document, and its channels by name."""
        run = self.run_tool('open', path, '--json', '-', *arguments)
        document = json.loads(run.stdout)
        return document, {c['name']: c for c in document['files'][0]['channels']}

    def records(self, path, *arguments):
        """Rows of each record, by file name: {column: values}."""
        out = self.path('out')
        run = self.run_tool('open', path, '-o', out, '--yes', *arguments)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        found = {}
        for name in sorted(os.listdir(out)):
            if not name.endswith('.csv'):
                continue
            lines = [line for line in pathlib.Path(out, name).read_text().split('\n') if line and line[0] != '#']
            rows = [[float(field) for field in line.split(',')] for line in lines[1:]]
            found[name] = dict(zip(lines[0].split(','), zip(*rows)))
        return found

    def refusal(self, path):
        run = self.run_tool('open', path)
        self.assertEqual(run.returncode, 9, run.stdout + run.stderr)
        self.assertIn(path, run.stderr)
        return run.stderr

    def expect_joint(self, record, share=1.0, rate=500.0, position='x_mm', speed='w_rad_s'):
        self.assertEqual(len(record['t_s']), ROWS)
        for k in range(0, ROWS, 37):
            x, v, m = made.motion(k, rate)
            self.assertAlmostEqual(record['t_s'][k], k / rate, delta=1e-9)
            self.assertAlmostEqual(record[position][k], share * x, delta=1e-9)
            self.assertAlmostEqual(record[speed][k], share * v, delta=1e-9)
            self.assertAlmostEqual(record['i_A'][k], share * m, delta=1e-9)

    def test_mcap_of_each_packing(self):
        for packing, chunked in (('', False), ('', True), ('lz4', True), ('zstd', True)):
            with self.subTest(packing=packing, chunked=chunked):
                path = self.path(f'log{packing}{chunked}.mcap')
                made.mcap(path, {'/joint_states': made.messages()}, packing, chunked)
                (record,) = self.records(path).values()
                self.expect_joint(record)
                subprocess.run(['rm', '-r', self.path('out')], check=True)

    def test_bag_in_both_byte_orders_with_and_without_stamps(self):
        for big in (False, True):
            for stamped in (False, True):
                with self.subTest(big=big, stamped=stamped):
                    path = self.path(f'log{big}{stamped}.db3')
                    made.bag(path, {'/joint_states': made.messages(big=big, stamped=stamped)})
                    before = sorted(os.listdir(self.folder.name))
                    (record,) = self.records(path).values()
                    self.expect_joint(record)
                    subprocess.run(['rm', '-r', self.path('out')], check=True)
                    self.assertEqual(sorted(os.listdir(self.folder.name)), before)

    def test_a_joint_may_turn_or_slide(self):
        path = self.path('a.mcap')
        made.mcap(path, {'/joint_states': made.messages()})
        document, channels = self.open(path)
        self.assertEqual(len(document['asks']), 1)
        self.assertIn('does the joint turn', document['asks'][0])
        for name, taken, unit in (('joint1.position', 'x_mm', 'rad or m'),
                                  ('joint1.velocity', 'w_rad_s', 'rad/s or m/s'), ('joint1.effort', 'i_A', 'Nm or N')):
            self.assertEqual(channels[name]['taken_as'], taken)
            self.assertLess(channels[name]['sure'], 0.9)
            self.assertIn(unit, channels[name]['why'])
            self.assertIn(made.JOINT_STATE, channels[name]['why'])
        told = document['asks'][0].split('--map ')[1]
        (record,) = self.records(path, '--map', told).values()
        self.expect_joint(record, position='x_m', speed='v_m_s')
        self.assertEqual(self.open(path, '--map', told)[0]['asks'], [])

    def test_the_data_sheet_says_what_a_joint_does(self):
        path = self.path('a.mcap')
        made.mcap(path, {'/joint_states': made.messages(rows=120)})  # too few for a verdict, which would take long
        for kind, told in (('rotary', ['--lead', '10']), ('linear', [])):
            sheet = self.path(f'{kind}.toml')
            run = self.run_tool('sheet', 'x', '-o', sheet, '--kind', kind, *told, '--kt', '0.5', '--step', '1e-4',
                                '--period', '0.002')
            self.assertEqual(run.returncode, 0, run.stderr)
            document, channels = self.open(path, '--sheet', sheet)
            self.assertEqual(document['asks'], [])
            self.assertEqual(channels['joint1.velocity']['taken_as'], 'w_rad_s' if kind == 'rotary' else 'v_mm_s')
            self.assertAlmostEqual(channels['joint1.position']['factor'],
                                   10 / (2 * math.pi) if kind == 'rotary' else 1e3)
            self.assertAlmostEqual(channels['joint1.effort']['factor'], 2.0)

    def test_each_joint_of_each_topic_makes_a_record(self):
        path = self.path('a.mcap')
        made.mcap(path, {'/arm/joint_states': made.messages(('j1', 'j2')),
                         '/hand/joint_states': made.messages(('j1',), rate=250.0, sign=-1.0)}, 'zstd')
        document, channels = self.open(path)
        self.assertIn('hand/joint_states/j1.position', channels)
        self.assertEqual(len(document['asks']), 3)
        found = self.records(path)
        self.assertEqual(len(found), 3)
        self.expect_joint(found['a-arm_joint_states_j1.csv'])
        self.expect_joint(found['a-arm_joint_states_j2.csv'], share=0.5)
        self.expect_joint(found['a-hand_joint_states_j1.csv'], share=-1.0, rate=250.0)

    def test_bags_without_joint_states_say_what_they_hold(self):
        path = self.path('a.db3')
        made.bag(path, {'/tf': [(1, b'\0\1\0\0')]}, 'tf2_msgs/msg/TFMessage')
        self.assertIn('/tf (tf2_msgs/msg/TFMessage, cdr)', self.refusal(path))
        made.mcap(self.path('a.mcap'), {'/tf': [(1, b'\0\1\0\0')]}, schema='tf2_msgs/msg/TFMessage')
        self.assertIn('/tf (tf2_msgs/msg/TFMessage, cdr)', self.refusal(self.path('a.mcap')))

    def test_broken_recordings_say_how_to_mend_them(self):
        made.mcap(self.path('a.mcap'), {'/joint_states': made.messages(rows=50)}, ended=False)
        self.assertIn('mcap recover', self.refusal(self.path('a.mcap')))
        made.mcap(self.path('b.mcap'), {'/joint_states': made.messages(rows=50)})
        whole = bytearray(pathlib.Path(self.path('b.mcap')).read_bytes())
        whole[whole.find(b'joint1') + 200] ^= 1  # within the chunk, so that its checksum is wrong
        pathlib.Path(self.path('b.mcap')).write_bytes(whole)
        self.assertIn('damaged', self.refusal(self.path('b.mcap')))
        made.bag(self.path('c.db3'), {'/joint_states': made.messages(rows=50)})
        os.truncate(self.path('c.db3'), os.path.getsize(self.path('c.db3')) - 100)  # SQLite reads zeros there
        self.assertIn('cut off', self.refusal(self.path('c.db3')))
        made.bag(self.path('a.db3'), {'/joint_states': made.messages(rows=50)})
        pathlib.Path(self.path('a.db3-wal')).write_bytes(b'rows')
        self.assertIn('wal_checkpoint', self.refusal(self.path('a.db3')))

    def test_files_that_are_not_read_say_how_to_convert_them(self):
        for name, start, remedy in (('a.parquet', b'PAR1' + bytes(40) + b'PAR1', 'read_parquet'),
                                    ('a.bag', b'#ROSBAG V2.0\n', 'rosbags-convert'),
                                    ('a.csv.gz', b'\x1f\x8b\x08', 'gunzip'), ('a.db3.zstd', b'\x28\xb5\x2f\xfd', 'unzstd')):
            pathlib.Path(self.path(name)).write_bytes(start)
            self.assertIn(remedy, self.refusal(self.path(name)))

    @unittest.skipUnless(h5py, 'needs python3-h5py')
    def test_hdf5(self):
        path = self.path('a.h5')
        rows = [made.motion(k) for k in range(ROWS)]
        x, v, m = (numpy.array(column) for column in zip(*rows))
        with h5py.File(path, 'w') as file:
            group = file.create_group('run/axis')
            group.attrs['rate'] = 500
            for name, values, unit in (('position', (180 / math.pi * x).astype('>f4'), 'deg'), ('speed', v, b'rad/s')):
                set_ = group.create_dataset(name, data=values, compression='gzip', chunks=(100,))
                set_.attrs['unit'] = unit
            table = numpy.zeros(ROWS, dtype=[('torque', '<f8'), ('state', '<u2')])
            table['torque'] = 1e3 * m
            file['drive'] = table
            file['drive'].attrs['units'] = ['mNm', '']
            file['pairs'] = numpy.stack([x, v], axis=1)
            file['wide'] = numpy.stack([x, v])
            file['note'] = 'text'
            group['again'] = h5py.SoftLink('/run')
            group['itself'] = group
            file['elsewhere'] = h5py.ExternalLink('b.h5', '/x')
        document, channels = self.open(path)
        self.assertEqual(document['files'][0]['rate_Hz'], 500)
        self.assertEqual(set(channels), {'run/axis/position', 'run/axis/speed', 'drive.torque', 'drive.state',
                                         'pairs(1)', 'pairs(2)', 'wide(1)', 'wide(2)', 'note'})
        self.assertAlmostEqual(channels['run/axis/position']['factor'], math.pi / 180)
        self.assertEqual(channels['run/axis/speed']['taken_as'], 'w_rad_s')
        self.assertAlmostEqual(channels['drive.torque']['factor'], 1e-3)
        told = 't_s=row*0.002,x_mm="wide(1)",w_rad_s="run/axis/speed",i_A=drive.torque*0.001'
        out = self.path('r.csv')
        run = self.run_tool('import', path, '--map', told, '-o', out)
        self.assertEqual(run.returncode, 0, run.stderr)
        lines = [line.split(',') for line in pathlib.Path(out).read_text().split('\n') if line and line[0] != '#']
        record = dict(zip(lines[0], zip(*[[float(f) for f in line] for line in lines[1:]])))
        self.expect_joint(record)

    @unittest.skipUnless(h5py, 'needs python3-h5py')
    def test_hdf5_reads_no_other_file(self):
        with h5py.File(self.path('b.h5'), 'w') as file:
            file['x'] = numpy.arange(100.0)
        pathlib.Path(self.path('raw')).write_bytes(bytes(800))
        with h5py.File(self.path('a.h5'), 'w') as file:
            layout = h5py.VirtualLayout(shape=(100,), dtype='f8')
            layout[:] = h5py.VirtualSource(self.path('b.h5'), 'x', shape=(100,))
            file.create_virtual_dataset('virtual', layout)
            file.create_dataset('outer', (100,), 'f8', external=[(self.path('raw'), 0, 800)])
            file['own'] = numpy.arange(100.0)
        run = self.run_tool('import', self.path('a.h5'), '--list')
        self.assertEqual(run.stdout.count('lies in another file'), 2, run.stdout)

    def test_blackbox_has_its_time_and_no_torque(self):
        for write, period_us in ((made.blackbox_decode, 500), (made.blackbox_decode, 125), (made.blackbox_explorer, 500),
                                 (made.blackbox_explorer, 125)):
            with self.subTest(write=write, period_us=period_us):
                path = self.path('flight.csv')
                write(path, period_us)
                document, channels = self.open(path)
                file = document['files'][0]
                self.assertEqual(file['layout'], 'betaflight')
                self.assertAlmostEqual(file['rate_Hz'], 1e6 / period_us)
                taken = {c['name']: c['taken_as'] for c in file['channels'] if c['taken_as']}
                self.assertEqual(list(taken.values()), ['t_s'], taken)
                self.assertEqual(channels[next(iter(taken))]['factor'], 1e-6)
                self.assertEqual(document['asks'], [])
                self.assertIn('gyroADC[0]', ' '.join(file['missing']))


if __name__ == '__main__':
    unittest.main()
