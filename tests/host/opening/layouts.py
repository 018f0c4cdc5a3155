#!/usr/bin/env python3
"""Twenty layouts of one made motion, opened by the program: layouts.py AXISTOOL [FOLDER]

Each layout has its own delimiter, decimal sign, preamble, language, units, encoding and time. Right: every quantity in
the log is taken with its factor (within 0.5 %), and information that the log lacks is in `missing` or `asks`. Silently
wrong: a wrong factor or quantity without a question and with a confidence of 90 % or more. At least 19 layouts must be
right, and none silently wrong.
"""
import json
import math
import os
import subprocess
import sys
import tempfile

ROWS, RATE = 4000, 1000.0
PI = math.pi
LEAD = 10.0 / (2 * PI)  # mm per radian


def motion(k, rate=RATE):
    """mm, mm/s, A at sample k: three sines, an inertia, viscous and dry friction."""
    t = k / rate
    x = v = a = 0.0
    for amplitude, f in ((20.0, 0.31), (6.0, 0.83), (1.5, 2.1)):
        w = 2 * PI * f
        x += amplitude * math.sin(w * t)
        v += amplitude * w * math.cos(w * t)
        a -= amplitude * w * w * math.sin(w * t)
    return x, v, 0.003 * a + 0.01 * v + (0.6 if v > 0 else -0.6)


def table(path, names, columns, sep=',', comma=False, before='', after_names='', encoding='utf-8', digits=6, rows=ROWS,
          stamp=lambda k: k / RATE, rate=RATE, blank=''):
    """columns: functions of (x, v, i); the first column is the time stamp; if it is None, there are no stamps."""
    lines = [before] if before else []
    if names is not None:
        lines.append(sep.join(names))
    if after_names:
        lines.append(after_names)
    for k in range(rows):
        fields = [] if stamp is None else [stamp(k)]
        fields += [c(*motion(k, rate)) for c in columns]
        text = [f if isinstance(f, str) else ('%.*f' % (digits, f)) for f in fields]
        if comma:
            text = [f.replace('.', ',') for f in text]
        lines.append(sep.join(text) + blank)
    with open(path, 'wb') as out:
        out.write('\n'.join(lines).encode(encoding) + b'\n')


X, V, I = (lambda x, v, i: x), (lambda x, v, i: v), (lambda x, v, i: i)
RAD = lambda x, v, i: x / LEAD
RADS = lambda x, v, i: v / LEAD
RPM = lambda x, v, i: v / LEAD * 30 / PI
MS = lambda k: k
MM, CUR, RPM_F = ('x_mm', 1.0), ('i_A', 1.0), ('w_rad_s', PI / 30)


def layouts(folder):
    """(name, path, {channel: (taken_as, factor)}, text that must be in `missing` or `asks`)"""
    out = []

    def add(name, expected, lacks=(), **how):
        path = os.path.join(folder, name + how.pop('ending', '.csv'))
        table(path, **how)
        out.append((name, path, expected, lacks))

    add('english-comma', {'pos [mm]': MM, 'current [A]': CUR}, names=['time [s]', 'pos [mm]', 'current [A]'], columns=[X, I])
    add('german-semicolon', {'Lageistwert [mm]': MM, 'Stromistwert [A]': CUR, 'Drehzahl [1/min]': RPM_F}, sep=';', comma=True,
        names=['Zeit [ms]', 'Lageistwert [mm]', 'Stromistwert [A]', 'Drehzahl [1/min]'], columns=[X, I, RPM], stamp=MS,
        before='Trace der Achse\nAbtastung: 1 ms')
    add('french-tab', {'Position (mm)': MM, 'Courant moteur (A)': CUR}, sep='\t', comma=True, encoding='cp1252',
        names=['Temps (s)', 'Position (mm)', 'Courant moteur (A)'], columns=[X, I], before='Mesure du moteur n° 3 à vide')
    add('spanish-units-row', {'Posición': MM, 'Corriente': CUR}, names=['Tiempo', 'Posición', 'Corriente'], columns=[X, I],
        after_names='s,mm,A')
    add('italian-bom', {'Posizione attuale [mm]': MM, 'Corrente [mA]': ('i_A', 1e-3)}, encoding='utf-8-sig', sep=';',
        names=['Tempo [s]', 'Posizione attuale [mm]', 'Corrente [mA]'], columns=[X, lambda x, v, i: 1e3 * i])
    add('russian', {'Положение, мм': MM, 'Ток, А': CUR}, sep=';', names=['Время, мс', 'Положение, мм', 'Ток, А'], columns=[X, I],
        stamp=MS, comma=True)
    add('chinese', {'实际位置(mm)': MM, '电流(A)': CUR}, names=['时间(ms)', '实际位置(mm)', '电流(A)'], columns=[X, I], stamp=MS)
    add('japanese-utf16', {'位置[mm]': MM, '電流[A]': CUR}, sep='\t', encoding='utf-16', names=['時間[s]', '位置[mm]', '電流[A]'], columns=[X, I])
    add('blanks', {'pos_mm': MM, 'i_A': CUR}, sep=' ', names=['t_s', 'pos_mm', 'i_A'], columns=[X, I], ending='.txt')
    add('inches', {'Position [in]': ('x_mm', 25.4), 'Current [A]': CUR}, names=['Time [s]', 'Position [in]', 'Current [A]'],
        columns=[lambda x, v, i: x / 25.4, I])
    add('degrees', {'angle [deg]': ('x_mm', PI / 180), 'torque [Nm]': CUR}, names=['time [s]', 'angle [deg]', 'torque [Nm]'],
        columns=[lambda x, v, i: x / LEAD * 180 / PI, I])
    add('turns', {'pos_turns': ('x_mm', 2 * PI), 'vel_rev/s': ('w_rad_s', 2 * PI), 'iq_A': CUR},
        names=['t_s', 'pos_turns', 'vel_rev/s', 'iq_A'], columns=[lambda x, v, i: x / LEAD / 2 / PI, lambda x, v, i: v / LEAD / 2 / PI, I])
    add('metres', {'x_m': ('x_mm', 1e3), 'force [N]': CUR}, names=['t_s', 'x_m', 'force [N]'], columns=[lambda x, v, i: 1e-3 * x, I])
    add('microseconds', {'pos_mm': MM, 'cur_A': CUR}, names=['time (us)', 'pos_mm', 'cur_A'], columns=[X, I], stamp=lambda k: 1000 * k)
    add('no-time-rate-in-preamble', {'pos_mm': MM, 'cur_A': CUR}, stamp=None, names=['pos_mm', 'cur_A'], columns=[X, I],
        before='Scope 2.1\nSample rate: 1 kHz')
    add('no-time-at-all', {'pos_mm': MM, 'cur_A': CUR}, lacks=['period'], stamp=None, names=['pos_mm', 'cur_A'], columns=[X, I])
    add('no-units', {}, lacks=['position', 'current'], names=['time', 'position', 'current'], columns=[RAD, I])
    add('counts-and-set-point', {'SetPos(mm)': ('x_ref_mm', 1.0), 'ActPos(inc)': ('x_mm', 10 / 65536), 'Iq(A)': CUR}, sep='\t',
        names=['Time(ms)', 'SetPos(mm)', 'ActPos(inc)', 'Iq(A)'], columns=[X, lambda x, v, i: '%d' % round(x * 6553.6), I], stamp=MS)
    add('counts-alone', {'Iq(A)': CUR}, lacks=['ActPos(inc)'], names=['Time(ms)', 'ActPos(inc)', 'Iq(A)'],
        columns=[lambda x, v, i: '%d' % round(x * 6553.6), I], stamp=MS)
    add('speed-says-otherwise', {'pos_mm': MM, 'cur_A': CUR}, lacks=['speed_mm/s'], names=['t_s', 'pos_mm', 'speed_mm/s', 'cur_A'],
        columns=[X, lambda x, v, i: 0.06 * v, I])
    return out


def judge(opened, expected, lacks):
    """('right' | 'incomplete' | 'wrong', reason)"""
    channels = {c['name']: c for c in opened['files'][0]['channels']}
    said = ' '.join(opened['asks'] + opened['files'][0]['missing'])
    verdict, why = 'right', ''
    for name, (taken, factor) in expected.items():
        c = channels.get(name, {'taken_as': '', 'factor': 0, 'sure': 0})
        good = c['taken_as'] == taken and abs(c['factor'] / factor - 1) < 5e-3
        if good:
            continue
        why += f" {name}: {c['taken_as'] or '-'} * {c['factor']:g};"
        silent = c['taken_as'] and c['sure'] >= 0.9
        verdict = 'wrong' if silent or verdict == 'wrong' else 'incomplete'
    for word in lacks:
        if word not in said:
            verdict, why = ('wrong', why + f' nothing is said of {word};')
    return verdict, why


def main():
    program = sys.argv[1]
    folder = sys.argv[2] if len(sys.argv) > 2 else tempfile.mkdtemp(prefix='layouts-')
    count = {'right': 0, 'incomplete': 0, 'wrong': 0}
    for name, path, expected, lacks in layouts(folder):
        run = subprocess.run([program, 'open', path, '--json', '-'], capture_output=True)
        try:
            verdict, why = judge(json.loads(run.stdout), expected, lacks)
        except ValueError:
            verdict, why = 'incomplete', ' ' + run.stderr.decode().strip()[:200]
        count[verdict] += 1
        print(f'{verdict:10} {name}{":" if why else ""}{why}')
    print(count)
    return 0 if count['right'] >= 19 and count['wrong'] == 0 else 1


if __name__ == '__main__':
    sys.exit(main())
