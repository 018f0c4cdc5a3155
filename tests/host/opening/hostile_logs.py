#!/usr/bin/env python3
"""Damaged and hostile binary logs: hostile_logs.py AXISTOOL [TRIES [SEED]]

The program must read every file or reject it with exit code 9, without a signal, a gigabyte of memory, a long delay or
written files. The files are: valid files of every kind from independent writers (log_files.py), cut off at TRIES
lengths, which must be rejected; the same with TRIES random changes each; and hostile files."""

import os
import random
import sqlite3
import struct
import subprocess
import sys
import tempfile
import time

import log_files as made

try:
    import h5py
    import numpy
except ImportError:
    h5py = None

PROGRAM = sys.argv[1]
TRIES = int(sys.argv[2]) if len(sys.argv) > 2 else 30
END = 64  # bytes at the end of a file, without which a reader can read it
LONGEST_S, MOST_BYTES = 60.0, 1 << 30  # a damaged file may take 5 s of processor time


def valid_files(folder):
    """{kind: path}"""
    rows = [made.motion(k) for k in range(120)]
    columns = dict(zip(('x', 'v', 'm'), zip(*rows)))
    topics = {'/joint_states': made.messages(('joint1', 'joint2'), rows=120)}
    paths = {}

    def path(name):
        paths[name] = os.path.join(folder, name)
        return paths[name]

    made.mcap(path('plain.mcap'), topics, chunked=False)
    made.mcap(path('chunked.mcap'), topics, per_chunk=50)
    made.mcap(path('lz4.mcap'), topics, 'lz4', per_chunk=50)
    made.mcap(path('zstd.mcap'), topics, 'zstd', per_chunk=50)
    made.bag(path('bag.db3'), topics)
    one = {'x': columns['x']}  # a file that is cut between variables is valid
    made.mat5(path('five.mat'), one)
    made.mat5(path('seven.mat'), one, compressed=True)
    if h5py is None:
        print('SKIPPED: HDF5, .npy and .npz need python3-h5py')
        return paths
    made.mat73(path('seven-three.mat'), columns)
    with h5py.File(path('log.h5'), 'w') as file:
        group = file.create_group('run')
        for name, values in columns.items():
            group.create_dataset(name, data=values, compression='gzip').attrs['units'] = 'rad'
        table = numpy.zeros(120, dtype=[('q', '<f4'), ('n', '<i2')])
        file['table'] = table
        file['wide'] = numpy.array(rows)
        file.attrs['dt'] = 0.002
    numpy.save(path('log.npy'), numpy.array(rows))
    numpy.save(path('fields.npy'), numpy.zeros(120, dtype=[('q', '<f4'), ('n', '>i2')]))
    numpy.savez(path('log.npz'), **columns)
    return paths


def made_on_purpose(folder):
    """{kind: (path, word in the error message)}"""
    out = {}

    def path(name, word):
        out[name] = (os.path.join(folder, name), word)
        return out[name][0]

    made.bag(path('endless.db3', 'longer than'), {'/joint_states': []})
    base = sqlite3.connect(out['endless.db3'][0])
    base.execute('DROP TABLE messages')
    base.execute("CREATE VIEW messages AS WITH RECURSIVE c(id) AS (SELECT 1 UNION ALL SELECT id + 1 FROM c) "
                 "SELECT id, 1 AS topic_id, 1 AS timestamp, x'00' AS data FROM c WHERE id < 0")
    base.commit()
    base.close()
    made.bag(path('large.db3', ''), {'/joint_states': []})
    base = sqlite3.connect(out['large.db3'][0])
    base.execute('DROP TABLE messages')
    base.execute('CREATE VIEW messages AS WITH RECURSIVE c(id) AS (SELECT 1 UNION ALL SELECT id + 1 FROM c) '
                 'SELECT id, 1 AS topic_id, 1 AS timestamp, zeroblob(60000000) AS data FROM c')
    base.commit()
    base.close()
    nothing = made.record(0x80, bytes(250 << 20))  # a record that readers skip
    inner = made.packed(nothing, 'zstd')
    chunk = made.record(6, struct.pack('<QQQI', 0, 0, len(nothing), 0) + made.text('zstd') +
                        struct.pack('<Q', len(inner)) + inner)
    with open(path('bomb.mcap', 'unpacks to more'), 'wb') as file:
        file.write(b'\x89MCAP0\r\n' + made.record(3, bytes(14)) + chunk * 20)
    with open(path('claims.mcap', 'unpacks to more'), 'wb') as file:
        claim = made.record(6, struct.pack('<QQQI', 0, 0, 1 << 62, 0) + made.text('lz4') + bytes(8))
        file.write(b'\x89MCAP0\r\n' + claim)
    names = [str(k) for k in range(900)]  # different joints in each message
    crowd = [(k, made.joint_state(k + 1, [f'{k}.{name}' for name in names], [], [], [])) for k in range(3)]
    made.mcap(path('crowd.mcap', 'more than 1000 joints'), {'/joint_states': crowd})
    if h5py is None:
        return out
    with h5py.File(path('huge.h5', '50000000'), 'w') as file:
        file.create_dataset('x', (1 << 40,), 'f8', chunks=(1 << 16,), compression='gzip')
    with h5py.File(path('chunk.h5', ''), 'w') as file:
        file.create_dataset('x', (40_000_000,), 'i1', chunks=(40_000_000,), compression='gzip')[:] = 1
        file.create_dataset('y', (3,), 'f8', chunks=(400_000_000,), maxshape=(None,), compression='gzip')
    with h5py.File(path('groups.h5', '20000'), 'w') as file:
        for k in range(20_500):
            file.create_group(f'g{k % 100}/{k}')
    return out


def run(path):
    """(exit code, output, seconds, bytes)"""
    started = time.monotonic()
    with tempfile.TemporaryFile() as said:
        child = subprocess.Popen([PROGRAM, 'import', path, '--list'], stdout=said, stderr=said)
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        said.seek(0)
        return child.returncode, said.read().decode(errors='replace'), time.monotonic() - started, usage.ru_maxrss * 1024


def damaged(whole, chance):
    """The file with some bytes changed, repeated or removed."""
    data = bytearray(whole)
    for _ in range(chance.choice((1, 1, 2, 8))):
        at = chance.randrange(len(data))
        how = chance.randrange(6)
        if how < 3:
            data[at] ^= 1 << chance.randrange(8)
        elif how == 3:
            data[at] = chance.choice((0, 1, 0x7f, 0x80, 0xff))
        elif how == 4:
            data[at:at + 8] = struct.pack('<Q', chance.choice((0, 1, 1 << 31, (1 << 32) - 1, (1 << 63) - 1, 1 << 40)))
        else:
            data[at:at + chance.randrange(64)] = data[at // 2:at // 2 + chance.randrange(64)]
    return bytes(data)


def main():
    chance = random.Random(int(sys.argv[3]) if len(sys.argv) > 3 else 1)
    faults = []

    def judge(name, path, word=None):
        before = sorted(os.listdir(os.path.dirname(path)))
        with open(path, 'rb') as file:
            whole = file.read()
        code, said, seconds, size = run(path)
        with open(path, 'rb') as file:
            untouched = file.read() == whole and sorted(os.listdir(os.path.dirname(path))) == before
        good = (code in ((9,) if word is not None else (0, 9)) and seconds < LONGEST_S and size < MOST_BYTES and untouched and
                (word or '') in said and (code == 0 or path in said))
        if not good:
            faults.append(f'{name}: exit code {code}, {seconds:.1f} s, {size >> 20} MiB, {"un" if untouched else ""}touched: '
                          f'{said[:200]}')
            kept = os.environ.get('HOSTILE_KEPT')
            if kept:
                with open(os.path.join(kept, f'{len(faults)}-{os.path.basename(path)}'), 'wb') as out:
                    out.write(whole)
        return code, seconds, size, 'fails on it' in said or 'longer than' in said

    with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryDirectory() as place:
        for name, path in valid_files(folder).items():
            code, said, _, _ = run(path)
            if code != 0:
                faults.append(f'{name}: refused although whole: {said}')
            with open(path, 'rb') as file:
                whole = file.read()
            cuts = [(whole[:chance.randrange(len(whole) - END)], '') for _ in range(TRIES)]
            seen = []
            for data, word in cuts + [(damaged(whole, chance), None) for _ in range(TRIES)]:
                broken = os.path.join(place, name)
                with open(broken, 'wb') as file:
                    file.write(data)
                seen.append(judge(name, broken, word))
            codes, times, sizes, ends = zip(*seen)
            print(f'{name:16} {len(whole):7} bytes: {codes.count(0):4} read, {codes.count(9):4} refused ({sum(ends)} for a '
                  f'crash or hang of the library); at most {max(times):.2f} s, {max(sizes) >> 20} MiB', flush=True)
        for name, (path, word) in made_on_purpose(place).items():
            code, seconds, size, _ = judge(name, path, word or (None if name == "chunk.h5" else ""))
            print(f'{name:16} exit code {code}, {seconds:.2f} s, {size >> 20} MiB', flush=True)
    print('\n'.join(faults) or 'no signal, no gigabyte, no long wait, nothing written')
    return 1 if faults else 0


if __name__ == '__main__':
    sys.exit(main())
