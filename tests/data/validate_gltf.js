// Checks a glTF file with Khronos' validator, of which this needs the npm package `gltf-validator`:
//
//     NODE_PATH=FOLDER/node_modules node tests/data/validate_gltf.js samples/assets/chess.gltf
//
// Exits with 1 if there is an error or a warning, and prints both.
const fs = require("fs");
const path = require("path");
const validator = require("gltf-validator");

const file = process.argv[2];
const read = (name) => new Uint8Array(fs.readFileSync(name));
const beside = async (uri) => read(path.join(path.dirname(file), uri));
// Programs may disagree about tangents on curved meshes. The normal map is on flat squares, where all get the same.
const ignoredIssues = ["MESH_PRIMITIVE_GENERATED_TANGENT_SPACE"];
validator.validateBytes(read(file), { uri: file, externalResourceFunction: beside, ignoredIssues }).then(({ issues }) => {
  const { numErrors, numWarnings, messages } = issues;
  console.log(`${file}: ${numErrors} errors, ${numWarnings} warnings`);
  messages.filter(({ severity }) => severity < 2).forEach((message) => console.log(message));
  process.exit(numErrors + numWarnings > 0 ? 1 : 0);
});
