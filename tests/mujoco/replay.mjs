// Torque that a motion needs according to MuJoCo: replay.mjs MODEL.xml MOTION PACKAGES. A row of the motion contains
// position, speed and acceleration of the joint. Prints the torque of the inverse dynamics for each row.
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { pathToFileURL } from 'node:url';

const [, , modelPath, motionPath, packages] = process.argv;
const entry = createRequire(`${packages}/`).resolve('@mujoco/mujoco');
const mujoco = await (await import(pathToFileURL(entry))).default();
const model = mujoco.MjModel.from_xml_string(readFileSync(modelPath, 'utf8'));
const data = new mujoco.MjData(model);
const torques = [];
for (const row of readFileSync(motionPath, 'utf8').trim().split('\n')) {
  [data.qpos[0], data.qvel[0], data.qacc[0]] = row.split(' ').map(Number);
  mujoco.mj_inverse(model, data);
  torques.push(data.qfrc_inverse[0]);
}
console.log(JSON.stringify({ torques, limit: model.actuator_ctrlrange[1], gear: model.actuator_gear[0] }));
