#!/usr/bin/env python3
"""Logs of real controllers, opened by the program without a map: real_logs.py AXISTOOL DATA

Prints for each file the number of channels in it, of those taken with a question, of those taken correctly without a
question, and of wrong ones. The sources of the files (the README and the converter beside each) determine what is
correct: stamps in seconds or in milliseconds, and speeds in rpm. Nothing else may be taken without a question. If no
channel of a file is taken, the program must name the missing information.
"""
import json
import math
import re
import subprocess
import sys
import tempfile
from pathlib import Path

FOLDERS = ('foreign-logs', 'real-logs', 'real', 'real-2')
NO_LOGS = ('.md', '.py', '.toml', '.m', '.json')
IN_MS = ('twincat-scope', 'leadscrew', 'worm-drive', 'a3MR')
IN_RPM = ('leadscrew', 'worm-drive')


def logs(data):
    for folder in FOLDERS:
        for path in sorted((data / folder).rglob('*')):
            is_raw = folder.endswith('logs') or 'raw' in path.parts
            if path.is_file() and is_raw and path.suffix not in NO_LOGS and path.name != 'LICENSE':
                yield path


def truth(path):
    """The expected factors of the quantities that are recognised without a question."""
    name = str(path)
    known = {'t_s': 1e-3 if any(part in name for part in IN_MS) else 1.0}
    if any(part in name for part in IN_RPM):
        known['w_rad_s'] = math.pi / 30.0
    return known


def row_of(program, path, folder):
    done = subprocess.run([program, 'open', str(path), '--yes', '--json', '-'], capture_output=True, text=True, cwd=folder,
                          check=False)
    document = json.loads(done.stdout) if done.stdout.startswith('{') else {'files': [], 'asks': []}
    missing = sum(len(one['missing']) for one in document['files'])
    row = {'holds': 0, 'asked': 0, 'right': 0, 'wrong': [], 'says': missing > 0 or done.stderr.strip() != ''}
    questions = '\n'.join(document['asks'])
    for channel in (channel for one in document['files'] for channel in one['channels']):
        row['holds'] += 1
        taken = channel['taken_as']
        if not taken:
            continue
        if re.search(r'=\s*"?' + re.escape(channel['name']), questions):
            row['asked'] += 1
        elif math.isclose(truth(path).get(taken, math.nan), channel['factor'], rel_tol=1e-6):
            row['right'] += 1
        else:
            row['wrong'].append(f"{channel['name']} as {taken}")
    return row


def main():
    program, data = str(Path(sys.argv[1]).resolve()), Path(sys.argv[2])
    if not data.is_dir():
        print(f'{data} is not there')
        sys.exit(77)
    files = wrong = silent = 0
    print(f"{'file':<80} holds asked right wrong")
    with tempfile.TemporaryDirectory() as folder:
        for path in logs(data):
            row = row_of(program, path, folder)
            files += 1
            wrong += len(row['wrong'])
            is_silent = row['asked'] + row['right'] == 0 and not row['says']
            silent += is_silent
            print(f"{str(path.relative_to(data))[-80:]:<80} {row['holds']:5} {row['asked']:5} {row['right']:5} "
                  f"{len(row['wrong']):5}  {'; '.join(row['wrong'])}{'says nothing' if is_silent else ''}", flush=True)
    print(f'{files} files, {wrong} channels wrong without a question, {silent} files of which nothing was said')
    sys.exit(wrong > 0 or silent > 0 or files == 0)


if __name__ == '__main__':
    main()
