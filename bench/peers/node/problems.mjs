// Equal problems, as each of the engines is told of them: z is up, lengths in m, masses in kg.

const gravity = 9.81;

/** The same rods by their angles, as a formula: T is a sum over pairs, V of each rod. Angles turn x towards the ground. */
function inAngles(count, length) {
  const names = Array.from({ length: count }, (_, i) => `a${i}`);
  const below = (i) => count - 1 - i; // rods that hang at its far end
  const terms = names.flatMap((a, i) => [
    `${length ** 2 * (1 / 3 + below(i)) / 2}*${a}'^2`, `${gravity * length * (below(i) + 0.5)}*sin(${a})`,
    ...names.slice(i + 1).map((b, k) => `${length ** 2 * (below(i + 1 + k) + 0.5)}*${a}'*${b}'*cos(${a} - ${b})`)]);
  const zeros = `[${names.map(() => "0.0")}]`;
  const scene = (settings) => (time) => `system = "lagrangian"\n[lagrangian]\ncoordinates = ${JSON.stringify(names)}\n` +
    `l = "${terms.join(" + ")}"\n[initial]\nposition = ${zeros}\nvelocity = ${zeros}\n${time}${settings}`;
  const read = ({ position }) => {
    let [x, z] = [0, 0];
    return { positions: position.map((angle) => {
      const [dx, dz] = [length * Math.cos(angle), -length * Math.sin(angle)];
      [x, z] = [x + dx, z + dz];
      return [x - dx / 2, 0, z - dz / 2];
    }) };
  };
  return [["midpoint", ""], ["gauss, order 4", 'method = "gauss"\norder = 4\n'], ["gauss, order 8", 'method = "gauss"\norder = 8\n']]
    .map(([method, settings]) => ({ method: `in angles, ${method}`, scene: scene(settings), read }));
}

/** Rods on hinges, let go from rest in a row along x; the first hangs at the origin. */
function rods(name, count, length, end, coarsest, comment) {
  const mass = 1;
  const inertia = [1e-3, mass * length ** 2 / 12, mass * length ** 2 / 12];
  const bodies = Array.from({ length: count }, (_, i) => ({ mass, inertia, position: [(i + 0.5) * length, 0, 0] }));
  const ours = [
    ...bodies.map(({ position }, i) => `[[body]]\nkind = "rigid"\nname = "rod-${i}"\nmass = ${mass}\n` +
      `inertia = [${inertia}]\nposition = [${position}]\n`),
    ...bodies.map((_, i) => `[[joint]]\nkind = "hinge"\nbetween = ["${i ? `rod-${i - 1}` : "ground"}", "rod-${i}"]\n` +
      `points = [[${i ? length / 2 : 0}, 0, 0], [${-length / 2}, 0, 0]]\naxis = [0, 1, 0]\n`),
    `[[effect]]\nkind = "gravity"\n`].join("\n");
  const nested = (i) => i === count ? "" : `<body pos="${i ? length : 0} 0 0"><joint type="hinge" axis="0 1 0"/>` +
    `<inertial pos="${length / 2} 0 0" mass="${mass}" diaginertia="${inertia.join(" ")}"/>${nested(i + 1)}</body>`;
  return {
    name, end, coarsest, comment, bodies, scale: mass * gravity * length * count * count / 2,
    state: ({ positions }) => positions.flat(),
    potential: (body, [, , z]) => body.mass * gravity * z,
    lagroid: [...[2, 4, 6].map((order) => ({
      method: order === 2 ? "bodies" : `bodies, order ${order}`,
      scene: (time) => `name = "${name}"\n${ours}\n${time}${order === 2 ? "" : `order = ${order}\n`}`,
      read: (final) => ({ positions: bodies.map((_, i) => final.position.slice(3 * i, 3 * i + 3)) }),
    })), ...inAngles(count, length)],
    reference: { method: "bodies, order 8", scene: (time) => `name = "${name}"\n${ours}\n${time}order = 8\n` },
    mujoco: {
      option: `gravity="0 0 ${-gravity}"`, flag: `contact="disable"`, world: nested(0), methods: ["Euler", "implicitfast", "RK4"],
    },
    rapier: ["impulse joints", "multibody joints"].map((method) => ({
      method,
      build(world, R) {
        const at = (x) => ({ x, y: 0, z: 0 });
        let before = world.createRigidBody(R.RigidBodyDesc.fixed());
        return bodies.map(({ position }, i) => {
          const body = world.createRigidBody(rigid(R, bodies[i]).setTranslation(...position));
          const joint = R.JointData.revolute(at(i ? length / 2 : 0), at(-length / 2), { x: 0, y: 1, z: 0 });
          if (method === "impulse joints") world.createImpulseJoint(joint, before, body, true);
          else world.createMultibodyJoint(joint, before, body, true);
          return (before = body);
        });
      },
      gravity,
    })),
  };
}

/** A body of Rapier with mass and moments, and nothing that slows it down or lets it sleep. */
function rigid(R, { mass, inertia }) {
  const [x, y, z] = inertia;
  return R.RigidBodyDesc.dynamic().setAdditionalMassProperties(mass, { x: 0, y: 0, z: 0 }, { x, y, z }, { x: 0, y: 0, z: 0, w: 1 })
    .setLinearDamping(0).setAngularDamping(0).setCanSleep(false);
}

function tumbling() {
  const body = { mass: 1, inertia: [1, 2, 3], position: [0, 0, 0] };
  const velocity = [0.01, 1, 0.01];
  const scene = (settings) => (time) => `system = "rigid_body"\n[parameters]\ninertia = [1, 2, 3]\n[initial]\nattitude = [1.0, 0, 0, 0]\n` +
    `momentum = [${velocity.map((w, i) => w * body.inertia[i])}]\n${time}${settings}`;
  return {
    name: "Tumbling body", end: 100, coarsest: 100, bodies: [body], scale: 1,
    comment: "A free body of moments 1, 2, 3 that turns nearly about its middle axis. Error: of its attitude, as a matrix.",
    state: ({ attitudes: [q] }) => matrix(q),
    potential: () => 0,
    lagroid: [["variational", ""], ["splitting, order 8", 'method = "splitting"\norder = 8\n'],
              ["Moser-Veselov, order 10", 'method = "moser-veselov"\norder = 10\n']].map(([method, settings]) => ({
      method, scene: scene(settings), read: (final) => ({ attitudes: [final.attitude] }) })),
    reference: { method: "Moser-Veselov, order 10", scene: scene('method = "moser-veselov"\norder = 10\n') },
    mujoco: {
      option: `gravity="0 0 0"`, flag: `contact="disable"`, methods: ["Euler", "implicitfast", "implicit", "RK4"],
      world: `<body><freejoint/><inertial pos="0 0 0" mass="1" diaginertia="1 2 3"/></body>`,
      begin: (data) => data.qvel.set([0, 0, 0, ...velocity]),
    },
    rapier: [{
      method: "free body", gravity: 0,
      build(world, R) {
        const [x, y, z] = velocity;
        const made = world.createRigidBody(rigid(R, body));
        made.setAngvel({ x, y, z }, true);
        return [made];
      },
    }],
  };
}

function turntable() {
  const [radius, rate, x, v, spin] = [0.2, 1.4, 0.5, 0.3, 0.7];
  const body = { mass: 1, inertia: [0.016, 0.016, 0.016], position: [x, 0, radius] };
  const rolling = (rate * x - v) / radius; // about x: the point of contact goes with the table
  const scene = (time) => `system = "rolling_ball"\n[parameters]\nradius = ${radius}\nplate_rate = ${rate}\n` +
    `[initial]\nposition = [${x}, 0.0]\nvelocity = [0.0, ${v}]\nspin = ${spin}\n${time}`;
  return {
    name: "Rolling ball", end: 2 * Math.PI / (2 / 7 * rate), coarsest: 100, bodies: [body], scale: 0.5 * v * v,
    comment: "A homogeneous ball rolls on a turntable, once round its circle, so that it should be back (exact). Error: of the place of its " +
      "centre on the table. In place of the energy, on which the table works, stands the kinetic one of the centre, which is constant.",
    state: ({ positions: [p] }) => p.slice(0, 2),
    exact: [x, 0],
    energy: ([{ velocity: [vx, vy] }]) => 0.5 * (vx * vx + vy * vy),
    lagroid: [{
      method: "nonholonomic", scene, read: (final) => ({ positions: [final.position] }),
      energy: (final) => 0.5 * (final.momentum[0] ** 2 + final.momentum[1] ** 2),
    }],
    mujoco: {
      option: `gravity="0 0 ${-gravity}" cone="elliptic" impratio="100"`, flag: "", methods: ["Euler", "implicitfast", "RK4"],
      world: `<body><joint type="hinge" axis="0 0 1"/><geom type="cylinder" size="2 0.1" pos="0 0 -0.1" mass="1e6"/></body>` +
        `<body pos="${body.position.join(" ")}"><freejoint/><geom type="sphere" size="${radius}" mass="1"/></body>`,
      begin: (data) => data.qvel.set([rate, 0, v, 0, rolling, 0, spin]),
      ball: 2,
    },
    rapier: [{
      method: "contact", gravity,
      build(world, R) {
        const plate = world.createRigidBody(R.RigidBodyDesc.kinematicVelocityBased().setTranslation(0, 0, -0.1)
          .setRotation({ x: Math.SQRT1_2, y: 0, z: 0, w: Math.SQRT1_2 })); // a cylinder's axis is y
        plate.setAngvel({ x: 0, y: 0, z: rate }, true);
        world.createCollider(R.ColliderDesc.cylinder(0.1, 2).setFriction(1), plate);
        const ball = world.createRigidBody(R.RigidBodyDesc.dynamic().setTranslation(...body.position)
          .setLinearDamping(0).setAngularDamping(0).setCanSleep(false));
        world.createCollider(R.ColliderDesc.ball(radius).setFriction(1).setMass(1), ball);
        ball.setLinvel({ x: 0, y: v, z: 0 }, true);
        ball.setAngvel({ x: rolling, y: 0, z: spin }, true);
        return [ball];
      },
    }],
  };
}

/** The rotation of a unit quaternion w, x, y, z, row by row. */
export function matrix([w, x, y, z]) {
  return [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),
          2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
          2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)];
}

/** Of bodies {position, attitude, velocity, angular velocity in space}. */
export function energy(problem, states) {
  if (problem.energy) return problem.energy(states);
  return states.reduce((sum, { position, attitude, velocity, turning }, i) => {
    const { mass, inertia } = problem.bodies[i];
    const A = matrix(attitude);
    const inBody = [0, 1, 2].map((k) => A[k] * turning[0] + A[3 + k] * turning[1] + A[6 + k] * turning[2]);
    const kinetic = mass * velocity.reduce((s, v) => s + v * v, 0) + inBody.reduce((s, w, k) => s + inertia[k] * w * w, 0);
    return sum + kinetic / 2 + problem.potential(problem.bodies[i], position);
  }, 0);
}

export const problems = [
  tumbling(),
  rods("Double pendulum", 2, 1, 3, 30, "Two rods of one metre on hinges, let go from the horizontal. Error: of the places of their centres."),
  rods("Chain", 10, 0.1, 1, 50, "Ten rods of a tenth of a metre on hinges, let go from the horizontal. Error: of the places of their centres."),
  turntable(),
];
