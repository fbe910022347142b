/* How well a page answers what is looked for; Sphinx takes it into the search of the guide. */

/* Words of the trade, and the page that answers them first. conf.py makes them keywords of that page. */
const TRADE_WORDS = {
  "tutorial/quick-start": "begin beginner tutorial customer steps quick start first",
  "how-to/install": "install uninstall remove removal update upgrade download windows mac",
  "how-to/open-scan": "scan import unit orientation axis repair hole crop mirror",
  "how-to/landmarks": "landmark landmarks nipple apex fold pin",
  "how-to/lines": "line lines slider strap straps sling ring preset draw",
  "how-to/target-shape": "target targets lift profile inverse",
  "how-to/diagnosis": "diagnose diagnosis conflict oscillation vibration diverged folded",
  "how-to/elastics": "elastic elastics newton newtons stretch elongation force",
  "how-to/cut-list": "cut length lengths band tension allowance seam strip strips pattern",
  "how-to/symmetry": "symmetry asymmetry balance uneven",
  "how-to/uncertainty": "uncertainty error plusminus sigma",
  "how-to/scan-comparison": "calibrate calibration residual fitting registration",
  "how-to/before-after": "compare section map displacement strain outline divider picture",
  "how-to/report": "report sheet pdf print printing paper",
  "how-to/export": "export pattern dxf svg clo seamly valentina turntable",
  "how-to/troubleshooting": "error trouble problem crash slow black backup restore reset",
  "reference/screens": "screen window tab panel shortcut shortcuts key keys view",
  "reference/model-options": "option options sliding bonded glued stiffness gain",
  "reference/measurements": "measure measurement measurements girth waist hip bust underbust volume depth width",
  "reference/sizes": "size sizes cup cups bra chart",
  "reference/settings": "settings preferences language inch theme",
  "reference/command-line": "command terminal script batch",
  "explanation/contact-pressure": "pressure press tight comfort kpa mmhg marks mark digging",
  "explanation/limitations": "limitations underwire underwires wire wires wing wings gusset gussets gore seam seams boning gravity accuracy privacy",
  "explanation/method": "method adaptive conventional mesh spring paper",
};

const LATER = new Set([
  "changes", "licences", "contributors/validation", "contributors/words", "explanation/reproduction",
  "reference/command-line", "reference/python-api",
]);

/* Of a page that answers every word asked for; of pages for programmers, unless they answer. */
const ANSWERS = 60, FOR_OTHERS = -30;

/* A word is asked for as it stands, or begun: "pressures" and "pressu" are both answered by "pressure". */
const answered = (page) => {
  const words = (TRADE_WORDS[page] || "").match(/\w+/g) || [];
  const asked = (new URLSearchParams(window.location.search).get("q") || "").toLowerCase().match(/\w{3,}/g) || [];
  return asked.length > 0 && asked.every((ask) => words.some((word) => word.startsWith(ask) || ask.startsWith(word)));
};

var Scorer = {
  score: ([page, , anchor, , score]) => {
    if (answered(page)) return score + ANSWERS + (anchor ? 0 : 1);
    return score + (LATER.has(page) ? FOR_OTHERS : 0);
  },
  objNameMatch: 11,
  objPartialMatch: 6,
  objPrio: { 0: 15, 1: 5, 2: -5 },
  objPrioDefault: 0,
  title: 30,
  partialTitle: 12,
  term: 5,
  partialTerm: 2,
};
