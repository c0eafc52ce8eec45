// Runs the job type with stand-ins for Flamenco's objects. Usage: node contrib_flamenco.js contrib/flamenco
const fs = require("fs"), vm = require("vm"), path = require("path");
const folder = process.argv[2];
const tasks = [];
const author = {
  Task: (name, type) => ({
    name, type, commands: [], before: [],
    addCommand(command) { this.commands.push(command); },
    addDependency(task) { this.before.push(task.name); },
  }),
  Command: (name, parameters) => ({name, ...parameters}),
};
const world = {author};
vm.createContext(world);
vm.runInContext(fs.readFileSync(path.join(folder, "kaustik.js"), "utf8") + "\nthis.JOB_TYPE = JOB_TYPE;", world);
const job = JSON.parse(fs.readFileSync(path.join(folder, "job.json"), "utf8"));
const known = world.JOB_TYPE.settings.map((setting) => setting.key);
const foreign = Object.keys(job.settings).filter((key) => !known.includes(key));
job.settings.parts = 3;
job.addTask = (task) => tasks.push(task);
world.compileJob(job);

const names = tasks.map((task) => task.name).join(" ");
const merge = tasks[tasks.length - 1], render = tasks[2];
const problems = [];
if (foreign.length) problems.push(`job.json sets what is no setting: ${foreign}`);
if (names !== "learn render-1 render-2 render-3 merge") problems.push(`tasks: ${names}`);
if (merge.before.join(" ") !== "render-1 render-2 render-3") problems.push(`merge waits for: ${merge.before}`);
if (!render.commands[0].args.join(" ").includes("--part 2/3")) problems.push(`part 2: ${render.commands[0].args}`);
for (const task of tasks)
  for (const word of task.commands[0].args)
    if (typeof word !== "string") problems.push(`${task.name}: ${word} is no text`);
problems.forEach((problem) => console.error(problem));
process.exit(problems.length ? 1 : 0);
