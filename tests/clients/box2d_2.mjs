// Box2D 2.4.1 compiled for the web (box2d-wasm): what `--to box2d` says under "2.4".
import {readFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {setFields} from './fields.mjs';

// Given its bytes, it does not try to fetch them from a server.
const require = createRequire(import.meta.url);
const file = require.resolve('box2d-wasm').replace('entry.js', 'Box2D');
const B = await require(`${file}.js`)({wasmBinary: readFileSync(`${file}.wasm`)});
const vec = ([x, y]) => new B.b2Vec2(x, y);

export function load(doc, choose) {
  const world = new B.b2World(vec(doc.gravity));
  const bodies = {};
  for (const b of doc.bodies) {
    const def = new B.b2BodyDef();
    def.type = {static: B.b2_staticBody, kinematic: B.b2_kinematicBody, dynamic: B.b2_dynamicBody}[b.type];
    def.position = vec(b.position);
    def.linearVelocity = vec(b.linearVelocity);
    def.angularVelocity = b.angularVelocity;
    def.allowSleep = b.allowSleep;
    const body = bodies[b.name] = world.CreateBody(def);
    for (const f of b.fixtures) {
      const fixture = new B.b2FixtureDef();
      fixture.shape = f.polygon ? polygon(f.polygon) : disc(f.circle, f.center);
      fixture.friction = f.friction;
      fixture.restitution = f.restitution;
      fixture.density = f.density;
      fixture.filter.groupIndex = f.groupIndex;
      body.CreateFixture(fixture);
    }
    if (b.type === 'dynamic') {
      const mass = new B.b2MassData();
      mass.mass = b.mass;
      mass.center = vec([0, 0]);
      mass.I = b.inertia;
      body.SetMassData(mass);
    }
  }
  const defs = {weld: B.b2WeldJointDef, revolute: B.b2RevoluteJointDef, prismatic: B.b2PrismaticJointDef,
                wheel: B.b2WheelJointDef, motor: B.b2MotorJointDef};
  for (const joint of doc.joints) {
    const {type, ...fields} = choose(joint)['2.4'];
    const def = new defs[type]();
    def.bodyA = bodies[joint.bodyA];
    def.bodyB = bodies[joint.bodyB];
    setFields(def, type, fields, (value) => Array.isArray(value) ? vec(value) : value);
    world.CreateJoint(def);
  }
  return {
    gravity: (g) => world.SetGravity(vec(g)),
    step: () => world.Step(1 / 60, 8, 3),
    angle: (name) => bodies[name].GetAngle(),
    position: (name) => [bodies[name].GetPosition().x, bodies[name].GetPosition().y],
    mass: (name) => bodies[name].GetMass(),
  };
}

function polygon(points) {
  const shape = new B.b2PolygonShape();
  shape.Set(array(points), points.length);
  return shape;
}
function disc(radius, center) {
  const shape = new B.b2CircleShape();
  shape.m_radius = radius;
  shape.m_p = vec(center);
  return shape;
}
/// A C array of b2Vec2.
function array(points) {
  const start = B._malloc(8 * points.length);
  points.flat().forEach((value, i) => { B.HEAPF32[(start >> 2) + i] = value; });
  return B.wrapPointer(start, B.b2Vec2);
}
