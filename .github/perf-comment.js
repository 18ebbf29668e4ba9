// Comments on a pull request where `make perf-ab` called a row faster, slower or worse, and only when
// these verdicts differ from those of the comment that is there. Called by workflows/ci.yml.
const fs = require('fs');

const RACE = 'results/perf-ab/last.json';
const MARK = 'mote perf-ab verdicts:';

// A row that says something: not the same as before, or not measured any more.
function speaks(row) {
    return row.worse || row.verdict === 'faster' || row.verdict === 'slower' || row.status === 'failed';
}

function verdict(row) {
    return row.status === 'measured' ? row.verdict : row.status;
}

function percent(ratio) {
    return ratio === null ? '-' : `${ratio >= 1 ? '+' : ''}${(100 * (ratio - 1)).toFixed(1)} %`;
}

function cell(text) {
    return String(text).replace(/\|/g, '\\|').replace(/[\r\n]+/g, ' ').replace(/[<>]/g, '');
}

// The comment for a race: what it says, and a line that tells one set of verdicts from another.
function describe(race) {
    const rows = race.rows.filter(speaks);
    const verdicts = rows.map(row => `${row.name}=${verdict(row)}`).sort().join(' ');
    const lines = rows.map(row => `| ${cell(row.name)} | ${verdict(row)} | ${percent(row.ratio)} | ` +
        `${percent(row.ci_low)} to ${percent(row.ci_high)} | ${cell(row.what)} |`);
    const table = rows.length === 0 ? ['No row differs any more.'] :
        ['| row | verdict | time | interval | what explains it |', '| --- | --- | ---: | --- | --- |', ...lines];
    const head = `**${cell(race.b)} against ${cell(race.a)}: ${race.verdict}** ` +
        `(${race.rows.length} rows, ${race.pairs} pairs of processes, ${Math.round(race.seconds)} s)`;
    return {verdicts, body: [head, '', ...table, '', `<!-- ${MARK} ${cell(verdicts)} -->`].join('\n')};
}

// The verdicts that a comment is about; null: it is none of ours.
function verdictsOf(body) {
    const found = new RegExp(`<!-- ${MARK} (.*) -->`).exec(body || '');
    return found ? found[1] : null;
}

async function main({github, context, core}) {
    if (!fs.existsSync(RACE)) {
        core.info(`${RACE}: not there: nothing was raced`);
        return;
    }
    const race = describe(JSON.parse(fs.readFileSync(RACE, 'utf8')));
    const issue = {...context.repo, issue_number: context.issue.number};
    const comments = await github.paginate(github.rest.issues.listComments, {...issue, per_page: 100});
    const ours = comments.filter(comment => verdictsOf(comment.body) !== null).pop();
    const before = ours ? verdictsOf(ours.body) : '';
    if (before === cell(race.verdicts)) {
        core.info('no verdict changed');
        return;
    }
    await github.rest.issues.createComment({...issue, body: race.body});
}

module.exports = main;
module.exports.describe = describe;
module.exports.verdictsOf = verdictsOf;
