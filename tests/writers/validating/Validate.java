import java.io.FileInputStream;
import java.io.InputStream;
import java.util.Collections;
import java.util.HashSet;
import java.util.List;
import java.util.Map;
import java.util.Set;
import java.util.TreeMap;
import javax.xml.parsers.DocumentBuilderFactory;
import org.verapdf.gf.foundry.VeraGreenfieldFoundryProvider;
import org.verapdf.pdfa.Foundries;
import org.verapdf.pdfa.PDFAParser;
import org.verapdf.pdfa.flavours.PDFAFlavour;
import org.verapdf.pdfa.results.TestAssertion;
import org.verapdf.pdfa.results.ValidationResult;
import org.verapdf.pdfa.validation.profiles.Profiles;
import org.verapdf.pdfa.validation.profiles.Rule;
import org.verapdf.pdfa.validation.profiles.ValidationProfile;
import org.verapdf.pdfa.validation.profiles.Variable;
import org.w3c.dom.Element;
import org.w3c.dom.NodeList;

/**
 * Prints a line for each file and profile of veraPDF, and one for each rule that is broken.
 *
 * <p>The library reads its profiles by JAXB, which Java has no more: they are read here as plain XML.
 */
public class Validate {
  static final String HOME = "/org/verapdf/pdfa/validation/";

  public static void main(String[] arguments) throws Exception {
    java.util.logging.LogManager.getLogManager().reset();
    VeraGreenfieldFoundryProvider.initialise();
    for (Object[] known : new Object[][] {{"PDFUA-1", PDFAFlavour.PDFUA_1}, {"PDFA-2A", PDFAFlavour.PDFA_2_A}}) {
      ValidationProfile profile = profile((String) known[0], (PDFAFlavour) known[1]);
      for (String file : arguments) {
        try (InputStream stream = new FileInputStream(file);
            PDFAParser parser = Foundries.defaultInstance().createParser(stream, (PDFAFlavour) known[1])) {
          ValidationResult result = Foundries.defaultInstance().createValidator(profile, false).validate(parser);
          System.out.println(String.join("\t", file, (String) known[0], result.isCompliant() ? "pass" : "fail",
              result.getTotalAssertions() + ""));
          Map<String, String> broken = new TreeMap<>();
          for (TestAssertion one : result.getTestAssertions()) {
            if (one.getStatus() == TestAssertion.Status.FAILED) {
              String rule = one.getRuleId().getClause() + "-" + one.getRuleId().getTestNumber();
              broken.putIfAbsent(rule, one.getMessage() + " " + one.getLocation().getContext());
            }
          }
          broken.forEach((rule, message) -> System.out.println("\t" + rule + "\t" + message));
        }
      }
    }
  }

  static ValidationProfile profile(String name, PDFAFlavour flavour) throws Exception {
    Element root;
    try (InputStream stream = Validate.class.getResourceAsStream(HOME + name + ".xml")) {
      root = DocumentBuilderFactory.newInstance().newDocumentBuilder().parse(stream).getDocumentElement();
    }
    Set<Rule> rules = new HashSet<>();
    NodeList elements = root.getElementsByTagName("rule");
    for (int index = 0; index < elements.getLength(); index++) {
      Element rule = (Element) elements.item(index);
      Element id = (Element) rule.getElementsByTagName("id").item(0);
      rules.add(Profiles.ruleFromValues(
          Profiles.ruleIdFromValues(
              PDFAFlavour.Specification.valueOf(id.getAttribute("specification")),
              id.getAttribute("clause"), Integer.parseInt(id.getAttribute("testNumber"))),
          rule.getAttribute("object"), Boolean.valueOf(rule.getAttribute("deferred")), rule.getAttribute("tags"),
          text(rule, "description"), text(rule, "test"),
          Profiles.errorFromValues(text(rule, "message"), Collections.emptyList()), List.of()));
    }
    Set<Variable> variables = new HashSet<>();
    elements = root.getElementsByTagName("variable");
    for (int index = 0; index < elements.getLength(); index++) {
      Element variable = (Element) elements.item(index);
      variables.add(Profiles.variableFromValues(variable.getAttribute("name"), variable.getAttribute("object"),
          text(variable, "defaultValue"), text(variable, "value")));
    }
    return Profiles.profileFromValues(flavour, Profiles.profileDetailsFromValues(name, name, "", new java.util.Date(0)),
        "", rules, variables);
  }

  static String text(Element element, String name) {
    NodeList elements = element.getElementsByTagName(name);
    return elements.getLength() == 0 ? "" : elements.item(0).getTextContent();
  }
}
