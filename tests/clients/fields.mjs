/// Sets the fields that `--to box2d` names in an engine's own def, which must have each of them.
export function setFields(def, type, fields, convert = (value) => value) {
  for (const [key, value] of Object.entries(fields)) {
    if (!(key in def)) throw new Error(`${type} has no ${key}`);
    def[key] = convert(value);
  }
}
